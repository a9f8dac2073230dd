// Writes what SeaPackage makes of a package: its arrays as the kernels take them, and its block.
using System;
using System.IO;
using FFTocean;

public static class Dump
{
    public static void Main(string[] arguments)
    {
        var sea = new SeaPackage(new SeaWaves(arguments[0]));
        Write("h0", sea.H0);
        Write("wave", sea.Wave);
        Write("twiddle", sea.Twiddle);
        File.WriteAllBytes("block", sea.Block());
        UnityEngine.Mesh mesh = SeaMesh.Rings(0.4f, 4000f, 36);
        Console.WriteLine(sea.MapTexels);
        for (int i = 0; i < mesh.triangles.Length; i += 3)
        {
            UnityEngine.Vector3 a = mesh.vertices[mesh.triangles[i]], b = mesh.vertices[mesh.triangles[i + 1]];
            UnityEngine.Vector3 c = mesh.vertices[mesh.triangles[i + 2]];
            // Unity's front faces are clockwise: seen from above with z up on the paper, the area is negative.
            if ((b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x) >= 0) throw new Exception("a face looks down: " + i / 3);
        }
    }

    private static void Write(string name, float[] numbers)
    {
        var bytes = new byte[4 * numbers.Length];
        Buffer.BlockCopy(numbers, 0, bytes, 0, bytes.Length);
        File.WriteAllBytes(name, bytes);
    }
}
