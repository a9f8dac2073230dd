// Reads the sidecar named first, then "x z t" lines of a file, and prints the height at each; or why the sea was refused.
using System;
using System.Globalization;
using System.IO;

public static class Ask
{
    public static void Main(string[] arguments)
    {
        CultureInfo c = CultureInfo.InvariantCulture;
        SeaHeights sea;
        try { sea = new SeaHeights(arguments[0]); }
        catch (InvalidDataException error) { Console.WriteLine("refused: " + error.Message); return; }
        foreach (string line in File.ReadAllLines(arguments[1]))
        {
            string[] p = line.Split(' ');
            Console.WriteLine(sea.At(double.Parse(p[0], c), double.Parse(p[1], c), double.Parse(p[2], c)).ToString("R", c));
        }
    }
}
