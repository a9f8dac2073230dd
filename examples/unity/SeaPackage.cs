// Not run in Unity: compiled against stubs of the classes that it uses; the layout of the bytes is
// compared with fftocean's.
using System;
using System.Collections.Generic;
using System.Linq;

namespace FFTocean
{
    // The waves of a package as the kernels take them: fftocean's docs/kernels.md has the bytes.
    public sealed class SeaPackage
    {
        public struct Tile
        {
            public int Nx, Ny, First, FirstMap; // samples; first texels of the tile
            public double Lx, Ly; // [m]
            public float Mixed; // power of two by which the mixed stretch is as large as the height
            public int Levels => 1 + Log2(Math.Max(Nx, Ny));
        }

        public const int MostSide = 512; // of the kernels: their numbers of a line take 16 KiB

        public readonly Tile[] Tiles;
        public readonly float[] H0, Wave, Twiddle; // four, two and two numbers an entry
        public readonly int Ticks, Texels, MapTexels; // MapTexels: without foam
        public readonly float Decay, Threshold, Strength; // of foam [s], [-], [1/s]

        public SeaPackage(SeaWaves sea)
        {
            var tiles = (List<object>)sea.Document["tiles"];
            Ticks = (int)(double)sea.Document["ticks"];
            var foam = (Dictionary<string, object>)sea.Document["foam"];
            Decay = (float)(double)foam["decay"];
            Threshold = (float)(double)foam["threshold"];
            Strength = (float)(double)foam["strength"];
            Tiles = new Tile[tiles.Count];
            for (int i = 0; i < Tiles.Length; i++)
            {
                var one = (Dictionary<string, object>)tiles[i];
                int[] n = ((List<object>)one["n"]).Select(side => (int)(double)side).ToArray();
                if (n.Max() > MostSide)
                    throw new NotSupportedException(
                        $"n of tile {i} must be at most {MostSide} for the kernels, got {n.Max()}");
                Tiles[i] = new Tile
                {
                    Nx = n[0], Ny = n[1], First = Texels, FirstMap = MapTexels,
                    Lx = sea.Sizes[i][0], Ly = sea.Sizes[i][1], Mixed = (float)(double)one["mixed"],
                };
                Texels += n[0] * n[1];
                MapTexels += 3 * TexelsOfLevels(n[0], n[1]);
            }
            H0 = new float[4 * Texels];
            Wave = new float[2 * Texels];
            for (int i = 0; i < Tiles.Length; i++) FillFactors(Tiles[i], sea);
            foreach (SeaWaves.Wave wave in sea.Waves) Put(Tiles[wave.Tile], wave);
            int longest = Tiles.Max(tile => Math.Max(tile.Nx, tile.Ny));
            Twiddle = new float[2 * longest];
            for (int i = 0; i < longest; i++)
            {
                Twiddle[2 * i] = (float)Math.Cos(2 * Math.PI * i / longest);
                Twiddle[2 * i + 1] = (float)Math.Sin(2 * Math.PI * i / longest);
            }
        }

        // 1 / (k tanh(k depth)) of every wavenumber.
        private void FillFactors(Tile tile, SeaWaves sea)
        {
            object given;
            sea.Document.TryGetValue("depth", out given);
            double depth = given == null ? double.PositiveInfinity : (double)given;
            for (int y = 0; y < tile.Ny; y++)
                for (int x = 0; x < tile.Nx; x++)
                {
                    double kx = 2 * Math.PI * Whole(x, tile.Nx) / tile.Lx;
                    double ky = 2 * Math.PI * Whole(y, tile.Ny) / tile.Ly;
                    double k = Math.Sqrt(kx * kx + ky * ky);
                    int texel = tile.First + y * tile.Nx + x;
                    Wave[2 * texel + 1] = k > 0 ? (float)(1 / (k * Math.Tanh(k * depth))) : 0;
                }
        }

        // A wave's h0 at k, and its complex conjugate at -k. SeaWaves has them doubled.
        private void Put(Tile tile, SeaWaves.Wave wave)
        {
            int at = tile.First + Mod(wave.My, tile.Ny) * tile.Nx + Mod(wave.Mx, tile.Nx);
            int opposite = tile.First + Mod(-wave.My, tile.Ny) * tile.Nx + Mod(-wave.Mx, tile.Nx);
            H0[4 * at] = (float)(wave.Re / 2);
            H0[4 * at + 1] = (float)(wave.Im / 2);
            H0[4 * opposite + 2] = (float)(wave.Re / 2);
            H0[4 * opposite + 3] = (float)(-wave.Im / 2);
            Wave[2 * at] = Wave[2 * opposite] = wave.Cycles;
        }

        // The block `Sea` of the kernels, without the numbers that change: 96 bytes and 64 a tile.
        public byte[] Block()
        {
            var block = new byte[96 + 64 * 16];
            for (int i = 0; i < Tiles.Length; i++)
            {
                Tile tile = Tiles[i];
                int at = 96 + 64 * i;
                foreach (int value in new[] { tile.Nx, tile.Ny, tile.First, tile.FirstMap })
                {
                    Put(block, at, value);
                    at += 4;
                }
                double dkx = 2 * Math.PI / tile.Lx, dky = 2 * Math.PI / tile.Ly;
                foreach (double value in new[] { tile.Lx, tile.Ly, dkx, dky, 1, tile.Mixed, 1, 1 })
                {
                    Put(block, at, (float)value);
                    at += 4;
                }
            }
            Put(block, 4, Ticks - 1);
            Put(block, 8, Tiles.Length);
            Put(block, 12, Twiddle.Length / 2);
            Put(block, 16, 1f / Ticks);
            Put(block, 64, Decay);
            Put(block, 68, Threshold);
            Put(block, 72, Strength);
            return block;
        }

        public static void Put(byte[] block, int at, int value) =>
            Array.Copy(BitConverter.GetBytes(value), 0, block, at, 4);

        public static void Put(byte[] block, int at, float value) =>
            Array.Copy(BitConverter.GetBytes(value), 0, block, at, 4);

        // Texels of all levels of a plane.
        public static int TexelsOfLevels(int nx, int ny)
        {
            int sum = nx * ny;
            while (nx * ny > 1)
            {
                nx = Math.Max(nx / 2, 1);
                ny = Math.Max(ny / 2, 1);
                sum += nx * ny;
            }
            return sum;
        }

        public static double Whole(int i, int n) => 2 * i < n ? i : i - n;

        public static int Mod(int a, int n) => (a % n + n) % n;

        public static int Log2(int n) => n > 1 ? 1 + Log2(n / 2) : 0;
    }
}
