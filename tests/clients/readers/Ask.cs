// Answers the questions of ask.txt by SeaWaves.cs: see tests/clients/sea_waves.py.
using System;
using System.Globalization;
using System.IO;
using System.Linq;

public static class Ask
{
    public static void Main()
    {
        CultureInfo c = CultureInfo.InvariantCulture;
        SeaWaves sea = null;
        foreach (string line in File.ReadAllLines("ask.txt"))
        {
            string[] words = line.Split(' ');
            if (words[0] == "sea")
            {
                try
                {
                    sea = words[2] == "-1" ? new SeaWaves(words[1]) : new SeaWaves(words[1], int.Parse(words[2]));
                    Console.WriteLine("ok " + sea.NeglectedRms.ToString("R", c));
                }
                catch (InvalidDataException error) { Console.WriteLine("error " + error.Message); }
                continue;
            }
            double[] p = words.Skip(1).Select(word => double.Parse(word, c)).ToArray();
            SeaWaves.Water w = words[0] == "at" ? sea.At(p[0], p[1], p[2]) : sea.Rest(p[0], p[1], p[2]);
            var all = new[] { w.X0, w.Y0, w.X, w.Y, w.Height, w.Nx, w.Ny, w.Nz, w.Residual, w.Jacobian };
            Console.WriteLine(string.Join(" ", all.Select(value => value.ToString("R", c))));
        }
    }
}
