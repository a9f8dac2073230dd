// The sea of a run-time package in C#, for Unity, .NET and mono, without a GPU:
//     fftocean export-sea -o sea
//     var sea = new SeaWaves("sea");       // every wave
//     var fast = new SeaWaves("sea", 500); // the strongest, without fast.NeglectedRms [m]
//     var water = sea.At(x, y, t);         // the water above a place: water.Height, .Nx, .Ny, .Nz
//     var buoy = sea.Rest(x0, y0, t);      // the water that rests at a place: buoy.X, .Y
// x east, y north, z up, metres, seconds. Unity: At(p.x, p.z, t), normal (Nx, Nz, Ny).
// Threads can share a sea. A damaged package is refused by an InvalidDataException, which names
// the file and the rule.
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Security.Cryptography;
using System.Text;

public sealed class SeaWaves
{
    public struct Wave
    {
        public int Tile, Mx, My, Cycles;
        public double Re, Im; // height: the real part of (Re + i Im) e^(i phase)
        public double Kx, Ky, F; // [rad/m], [m]
        public double Square => Re * Re + Im * Im;
    }

    public struct Water
    {
        public double X0, Y0; // place at rest [m]
        public double X, Y, Height; // place now [m]
        public double Nx, Ny, Nz; // unit normal, Nz up
        public double Residual; // distance from the place that was asked for [m]
        public double Jacobian; // 0 or less: in a fold, one of several
        public double Xx, Xy, Yy; // of the place now: dX/dX0, dX/dY0 = dY/dX0, dY/dY0
    }

    public const int Most = 1 << 20, Deepest = 32; // bytes and depth of sea.json

    public readonly Dictionary<string, object> Document;
    public readonly Wave[] Waves;
    public readonly double[][] Sizes; // of the tiles [m]
    public readonly double Loop, Choppiness, NeglectedRms; // [s], [-], [m]

    public SeaWaves(string folder, int strongest = int.MaxValue)
        : this(name => Bytes(Path.Combine(folder, name)), strongest) { }

    // read(name) gives a file's bytes; null: it does not exist.
    public SeaWaves(Func<string, byte[]> read, int strongest = int.MaxValue)
    {
        Document = Parsed(read("sea.json"));
        Must(IsPositive(Get(Document, "loop")), "loop of sea.json must be a positive number");
        Must(Get(Document, "choppiness") is double, "choppiness of sea.json must be a number");
        object depth = Get(Document, "depth");
        Must(depth == null || IsPositive(depth),
            "depth of sea.json must be null or a positive number");
        Loop = (double)Get(Document, "loop");
        Choppiness = (double)Get(Document, "choppiness");
        var tiles = (List<object>)Get(Document, "tiles");
        Sizes = new double[tiles.Count][];
        var all = new List<Wave>();
        for (int i = 0; i < tiles.Count; i++)
            Add(all, i, tiles[i], (double?)depth ?? double.PositiveInfinity, read);
        Wave[] sorted = all.OrderByDescending(wave => wave.Square).ToArray(); // a stable sort
        Waves = sorted.Take(strongest).ToArray();
        NeglectedRms = Math.Sqrt(sorted.Skip(Waves.Length).Sum(wave => wave.Square / 2));
    }

    // Water that rests at (x0, y0): it is at (X, Y, Height) now.
    public Water Rest(double x0, double y0, double t) => At(x0, y0, x0, y0, t);

    // Water above (x, y), that is x0 + choppiness D(x0) = x, by Newton's method.
    public Water At(double x, double y, double t)
    {
        Water w = At(x, y, x, y, t);
        double least = w.Jacobian;
        for (int i = 0; i < 30 && w.Residual > 1e-9; i++)
        {
            double dx = w.X - x, dy = w.Y - y;
            double j = Math.Max(w.Jacobian, 0.2); // short steps near a fold
            double x0 = w.X0 - (w.Yy * dx - w.Xy * dy) / j, y0 = w.Y0 - (w.Xx * dy - w.Xy * dx) / j;
            w = At(x, y, x0, y0, t);
            least = Math.Min(least, w.Jacobian);
        }
        w.Jacobian = least;
        return w;
    }

    private Water At(double x, double y, double x0, double y0, double t)
    {
        double now = t % Loop / Loop, c = Choppiness;
        var place = new double[Sizes.Length][]; // in each tile's own period
        for (int i = 0; i < place.Length; i++)
            place[i] = new[] { x0 % Sizes[i][0] / Sizes[i][0], y0 % Sizes[i][1] / Sizes[i][1] };
        double height = 0, dx = 0, dy = 0, sx = 0, sy = 0, xx = 0, xy = 0, yy = 0;
        foreach (Wave w in Waves)
        {
            double turn = w.Mx * place[w.Tile][0] + w.My * place[w.Tile][1] - w.Cycles * now;
            double angle = 2 * Math.PI * (turn - Math.Round(turn));
            double cos = Math.Cos(angle), sin = Math.Sin(angle);
            double a = w.Re * cos - w.Im * sin, b = w.Re * sin + w.Im * cos;
            double fa = w.F * a, fb = w.F * b;
            height += a;
            sx -= w.Kx * b; sy -= w.Ky * b; dx -= w.Kx * fb; dy -= w.Ky * fb;
            xx -= w.Kx * w.Kx * fa; xy -= w.Kx * w.Ky * fa; yy -= w.Ky * w.Ky * fa;
        }
        xx = 1 + c * xx; xy *= c; yy = 1 + c * yy;
        double nx = xy * sy - yy * sx, ny = xy * sx - xx * sy, nz = xx * yy - xy * xy;
        double length = Math.Sqrt(nx * nx + ny * ny + nz * nz);
        double toX = x0 + c * dx, toY = y0 + c * dy;
        return new Water
        {
            X0 = x0, Y0 = y0, X = toX, Y = toY, Height = height,
            Nx = nx / length, Ny = ny / length, Nz = nz / length, Jacobian = nz,
            Residual = Math.Sqrt((toX - x) * (toX - x) + (toY - y) * (toY - y)),
            Xx = xx, Xy = xy, Yy = yy,
        };
    }

    // The document, checked: its checksum is that of all before the last key.
    private static Dictionary<string, object> Parsed(byte[] bytes)
    {
        Must(bytes != null, "sea.json does not exist");
        Must(bytes.Length <= Most, $"sea.json must have at most {Most} bytes, got {bytes.Length}");
        string text = Encoding.UTF8.GetString(bytes);
        var tree = new Json(text).Document() as Dictionary<string, object>;
        object format = Get(tree, "format"), version = Get(tree, "version");
        Must(format is string && (string)format == "fftocean-runtime",
            $"format of sea.json must be fftocean-runtime, got {format}");
        Must(version is double && (double)version == 1,
            $"version of sea.json must be 1, got {version}");
        string check = Get(tree, "check") as string, end = $",\n  \"check\": \"{check}\"\n}}\n";
        Must(text.EndsWith(end, StringComparison.Ordinal)
            && Sha256(Encoding.UTF8.GetBytes(text.Substring(0, text.Length - end.Length) + "\n}\n"))
                == check,
            "sea.json was changed after it was written");
        Must(IsPower(Get(tree, "ticks"), 1 << 20),
            "ticks of sea.json must be a power of two from 2 to 1048576");
        var tiles = Get(tree, "tiles") as List<object>;
        Must(tiles != null && tiles.Count > 0 && tiles.Count <= 16,
            "tiles of sea.json must be a list of 1 to 16");
        Must(Get(tree, "files") is List<object>, "files of sea.json must be a list");
        return tree;
    }

    private void Add(
        List<Wave> all, int index, object tile, double depth, Func<string, byte[]> read)
    {
        string name = $"tile{index}.waves", of = $"of tile {index} in sea.json must";
        var n = Get(tile, "n") as List<object>;
        var size = Get(tile, "size") as List<object>;
        Must(n != null && n.Count == 2 && n.All(side => IsPower(side, 1024)),
            $"n {of} be two powers of two from 2 to 1024");
        Must(size != null && size.Count == 2 && size.All(IsPositive),
            $"size {of} be two positive numbers");
        int nx = (int)(double)n[0], ny = (int)(double)n[1];
        Sizes[index] = new[] { (double)size[0], (double)size[1] };
        object count = Get(tile, "waves"), fastest = Get(tile, "most_cycles");
        Must(IsWhole(count, nx * ny) && IsWhole(fastest, 65535),
            $"waves {of} fit its n and most_cycles");
        int expected = 14 * (int)(double)count, most = (int)(double)fastest;
        object row = ((List<object>)Get(Document, "files")).FirstOrDefault(
            file => Get(file, "name") as string == name);
        string digest = Get(row, "sha256") as string;
        Must(Equals(Get(row, "bytes"), (double)expected) && digest != null && digest.Length == 64,
            $"sea.json must list {name} with {expected} bytes and its SHA-256");
        byte[] bytes = read(name);
        Must(bytes != null, $"{name} does not exist");
        Must(bytes.Length == expected, $"{name} must have {expected} bytes, got {bytes.Length}");
        Must(Sha256(bytes) == digest, $"{name} was changed after it was written");
        for (int i = 0, last = -1; i < expected / 14; i++)
        {
            var w = new Wave { Tile = index, Mx = (short)Word(bytes, 14 * i) };
            w.My = (short)Word(bytes, 14 * i + 2);
            w.Cycles = Word(bytes, 14 * i + 4);
            w.Re = 2 * Single(bytes, 14 * i + 6);
            w.Im = 2 * Single(bytes, 14 * i + 10);
            w.Kx = 2 * Math.PI * w.Mx / Sizes[index][0];
            w.Ky = 2 * Math.PI * w.My / Sizes[index][1];
            double k = Math.Sqrt(w.Kx * w.Kx + w.Ky * w.Ky);
            w.F = 1 / (k * Math.Tanh(k * depth));
            int place = (w.My + ny) % ny * nx + (w.Mx + nx) % nx;
            bool inside = 2 * Math.Abs(w.Mx) < nx && 2 * Math.Abs(w.My) < ny;
            string rule = !inside || (w.Mx == 0 && w.My == 0)
                ? $"have |mx| < {nx / 2} and |my| < {ny / 2}, not both 0"
                : place <= last ? "follow the one before in the plane"
                : !(w.Square > 0 && w.Square < double.PositiveInfinity)
                    ? "have a finite amplitude, not 0"
                : w.Cycles < 1 || w.Cycles > most ? $"have 1 to {most} cycles" : null;
            Must(rule == null, $"record {i} of {name} must {rule}");
            last = place;
            all.Add(w);
        }
    }

    private static int Word(byte[] bytes, int at) => bytes[at] | bytes[at + 1] << 8;

    private static double Single(byte[] bytes, int at)
    {
        var four = new[] { bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3] };
        if (!BitConverter.IsLittleEndian) Array.Reverse(four);
        return BitConverter.ToSingle(four, 0);
    }

    private static byte[] Bytes(string path)
    {
        if (!File.Exists(path)) return null;
        Must(new FileInfo(path).Length <= 14 << 20, $"{Path.GetFileName(path)} is too long");
        return File.ReadAllBytes(path);
    }

    private static string Sha256(byte[] bytes)
    {
        using (SHA256 sha256 = SHA256.Create())
            return string.Concat(sha256.ComputeHash(bytes).Select(b => b.ToString("x2")));
    }

    private static void Must(bool right, string rule)
    {
        if (!right) throw new InvalidDataException(rule);
    }

    private static object Get(object tree, string key)
    {
        object value = null;
        (tree as Dictionary<string, object>)?.TryGetValue(key, out value);
        return value;
    }

    private static bool IsPositive(object value) => value is double && (double)value > 0;

    private static bool IsWhole(object value, int most) =>
        value is double && (double)value >= 0 && (double)value <= most
        && (double)value == Math.Floor((double)value);

    private static bool IsPower(object value, int most) =>
        IsWhole(value, most) && (double)value >= 2
        && ((int)(double)value & ((int)(double)value - 1)) == 0;

    // JSON as dictionaries, lists, strings, doubles (finite), booleans and null.
    private sealed class Json
    {
        private readonly string s;
        private int at;

        public Json(string text) { s = text; }

        public object Document()
        {
            object value = Value(0);
            Space();
            Need(at == s.Length);
            return value;
        }

        private static void Need(bool right) => Must(right, "sea.json must be JSON");

        private char Here => at < s.Length ? s[at] : '\0';

        private void Space() { while (at < s.Length && " \n\r\t".IndexOf(s[at]) >= 0) at++; }

        private bool Take(string word)
        {
            bool same = string.CompareOrdinal(s, at, word, 0, word.Length) == 0;
            if (same) at += word.Length;
            return same;
        }

        private object Value(int depth)
        {
            Must(depth <= Deepest, $"sea.json must nest at most {Deepest} deep");
            Space();
            var keys = new Dictionary<string, object>();
            var items = new List<object>();
            if (Take("{"))
            {
                for (Space(); !Take("}"); Space())
                {
                    if (keys.Count > 0) { Need(Take(",")); Space(); }
                    Need(Take("\""));
                    string key = Text();
                    Space();
                    Need(Take(":"));
                    keys[key] = Value(depth + 1);
                }
                return keys;
            }
            if (Take("["))
            {
                for (Space(); !Take("]"); Space())
                {
                    if (items.Count > 0) Need(Take(","));
                    items.Add(Value(depth + 1));
                }
                return items;
            }
            if (Take("\"")) return Text();
            if (Take("null")) return null;
            if (Take("true")) return true;
            if (Take("false")) return false;
            int start = at;
            while (at < s.Length && "+-.0123456789eE".IndexOf(s[at]) >= 0) at++;
            double number;
            Need(double.TryParse(s.Substring(start, at - start), NumberStyles.Float,
                CultureInfo.InvariantCulture, out number) && !double.IsInfinity(number));
            return number;
        }

        // Escapes stay as they are, but for quotes: no key or value that is used here has any.
        private string Text()
        {
            var text = new StringBuilder();
            for (; Here != '"'; at++)
            {
                if (Here == '\\') at++;
                Need(at < s.Length);
                text.Append(s[at]);
            }
            at++;
            return text.ToString();
        }
    }
}
