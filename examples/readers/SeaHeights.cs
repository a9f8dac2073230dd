// Heights of a baked sea in Unity:
//     fftocean bake sea.toml -o sea --engine unity --maps height --format bin --lookup eulerian
//     var sea = new SeaHeights("sea/height.json");
//     float y = sea.At(boat.position.x, boat.position.z, Time.timeAsDouble);
using System;
using System.IO;
using UnityEngine;

public sealed class SeaHeights
{
    [Serializable]
    private struct Channels { public string R; }

    [Serializable]
    private struct Sidecar
    {
        public int schema, levels, frames, rows, columns, row_origin, row_sign;
        public string dtype, lookup, file;
        public bool closes;
        public Channels channels;
        public float loop, start;
        public float[] size;
    }

    private readonly Sidecar s;
    private readonly float[] heights; // [frame, row, column], metres

    public SeaHeights(string json)
    {
        s = JsonUtility.FromJson<Sidecar>(File.ReadAllText(json));
        Require(s.schema == 1, $"schema must be 1, got {s.schema}");
        Require(s.dtype == "float16, little-endian",
            $"dtype must be float16, little-endian, got {s.dtype}");
        Require(s.levels == 1, $"levels must be 1, got {s.levels}");
        Require(s.lookup == "eulerian", $"lookup must be eulerian, got {s.lookup}");
        Require(s.closes, "closes must be true: a part of a loop cannot be repeated");
        Require(s.channels.R == "height", $"R must be height, got {s.channels.R}");
        byte[] bytes = File.ReadAllBytes(Path.Combine(Path.GetDirectoryName(json), s.file));
        heights = new float[s.frames * s.rows * s.columns];
        Require(bytes.LongLength == 8L * heights.Length,
            $"{s.file} must have {8L * heights.Length} bytes, got {bytes.LongLength}");
        for (int i = 0; i < heights.Length; i++)
            heights[i] = Mathf.HalfToFloat(BitConverter.ToUInt16(bytes, 8 * i)); // R of RGBA
    }

    // Bilinear between samples, linear between frames; the sea repeats in x, z and t.
    public float At(double x, double z, double t)
    {
        double frame = (t - s.start) / s.loop * s.frames;
        double row = s.row_origin + s.row_sign * z / s.size[1] * s.rows;
        double column = x / s.size[0] * s.columns;
        double f = Math.Floor(frame), r = Math.Floor(row), c = Math.Floor(column), sum = 0.0;
        for (int corner = 0; corner < 8; corner++)
        {
            int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
            double weight = (i == 0 ? 1 - (frame - f) : frame - f)
                * (j == 0 ? 1 - (row - r) : row - r)
                * (k == 0 ? 1 - (column - c) : column - c);
            int line = Wrap(f + i, s.frames) * s.rows + Wrap(r + j, s.rows);
            sum += weight * heights[line * s.columns + Wrap(c + k, s.columns)];
        }
        return (float)sum;
    }

    private static void Require(bool right, string rule)
    {
        if (!right) throw new InvalidDataException(rule);
    }

    private static int Wrap(double i, int n) => (int)(i - n * Math.Floor(i / n));
}
