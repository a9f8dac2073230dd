// Not run in Unity: compiled against stubs of the classes that it uses. Compare frame 0 with the first file.
//
// Import of a bake into Unity 2021.3 or later, beside the maps of
//     fftocean bake sea.toml -o Assets/Sea --engine unity --format bin     (or exr, exr-float, exr-atlas)
// Textures of the bake are imported as data: linear, uncompressed, repeating, without mipmaps. The menu
// Assets > fftocean > Build texture arrays makes a Texture2DArray of each map, one slice a frame.
#if UNITY_EDITOR
using System;
using System.IO;
using System.Linq;
using UnityEditor;
using UnityEngine;

namespace FFTocean
{
    /// <summary>Numbers of a map's sidecar, or of a manifest, that the import needs.</summary>
    [Serializable]
    public class BakeSidecar
    {
        public string dtype;
        public int frames, rows, columns, levels;
        public int[] tiles;
    }

    public class BakeImport : AssetPostprocessor
    {
        private const string Script = "FFToceanBakeImport.cs";

        /// <summary>Return the folder of the bake that a texture belongs to, or null.</summary>
        private static string BakeOf(string path)
        {
            for (var folder = Path.GetDirectoryName(path); !string.IsNullOrEmpty(folder); folder = Path.GetDirectoryName(folder))
                if (File.Exists(Path.Combine(folder, Script)))
                    return File.Exists(Path.Combine(folder, "manifest.json")) || File.Exists(Path.Combine(folder, "cascade.json"))
                        ? folder : null;
            return null;
        }

        private void OnPreprocessTexture()
        {
            if (!assetPath.EndsWith(".exr") || BakeOf(assetPath) == null) return;
            var importer = (TextureImporter)assetImporter;
            var settings = new TextureImporterSettings();
            importer.ReadTextureSettings(settings);
            settings.textureType = TextureImporterType.Default;
            settings.sRGBTexture = false;
            settings.alphaSource = TextureImporterAlphaSource.FromInput; // the fourth channel of derivative is data
            settings.alphaIsTransparency = false;
            settings.mipmapEnabled = false;
            settings.npotScale = TextureImporterNPOTScale.None;
            settings.wrapMode = TextureWrapMode.Repeat;
            settings.filterMode = FilterMode.Bilinear;
            settings.readable = true; // for the arrays; switch it off once they are built
            var sidecar = Read(Path.ChangeExtension(assetPath, ".json"));
            if (sidecar != null && sidecar.tiles != null && sidecar.tiles.Length == 2)
            {
                settings.textureShape = TextureImporterShape.Texture2DArray;
                settings.flipbookColumns = sidecar.tiles[0];
                settings.flipbookRows = sidecar.tiles[1];
            }
            importer.SetTextureSettings(settings);
            var platform = importer.GetDefaultPlatformTextureSettings();
            platform.format = IsSingle(assetPath) ? TextureImporterFormat.RGBAFloat : TextureImporterFormat.RGBAHalf;
            platform.maxTextureSize = 16384;
            importer.SetPlatformTextureSettings(platform);
        }

        /// <summary>Return whether the bake of a file stores single precision.</summary>
        private static bool IsSingle(string path)
        {
            var manifest = Path.Combine(BakeOf(path), "manifest.json");
            return File.Exists(manifest) && File.ReadAllText(manifest).Contains("\"bake.format\": \"exr-float\"");
        }

        private static BakeSidecar Read(string path)
        {
            return File.Exists(path) ? JsonUtility.FromJson<BakeSidecar>(File.ReadAllText(path)) : null;
        }

        [MenuItem("Assets/fftocean/Build texture arrays")]
        private static void Build()
        {
            var folder = AssetDatabase.GetAssetPath(Selection.activeObject);
            if (!Directory.Exists(folder)) folder = Path.GetDirectoryName(folder);
            if (BakeOf(folder + "/manifest.json") == null)
                throw new InvalidOperationException(folder + " must be the folder of a bake with " + Script);
            foreach (var file in Directory.GetFiles(folder, "*.bin")) Save(FromBytes(file), file);
            foreach (var map in Directory.GetDirectories(folder))
            {
                var frames = Directory.GetFiles(map, "*.exr").OrderBy(name => name, StringComparer.Ordinal).ToArray();
                if (frames.Length > 0) Save(FromFrames(frames), map);
            }
            AssetDatabase.SaveAssets();
        }

        private static Texture2DArray FromBytes(string file)
        {
            var s = Read(Path.ChangeExtension(file, ".json"));
            if (s == null || s.dtype != "float16, little-endian" || s.levels != 1)
                throw new InvalidDataException(file + " must have a sidecar of half floats with one level");
            var bytes = File.ReadAllBytes(file);
            var one = s.rows * s.columns * 8;
            if (bytes.Length != s.frames * one)
                throw new InvalidDataException(file + " must have " + s.frames * one + " bytes, got " + bytes.Length);
            var array = Empty(s.columns, s.rows, s.frames, TextureFormat.RGBAHalf);
            for (var frame = 0; frame < s.frames; frame++) array.SetPixelData(bytes, 0, frame, frame * one);
            array.Apply(false);
            return array;
        }

        private static Texture2DArray FromFrames(string[] files)
        {
            Texture2DArray array = null;
            for (var frame = 0; frame < files.Length; frame++)
            {
                var texture = AssetDatabase.LoadAssetAtPath<Texture2D>(files[frame].Replace('\\', '/'));
                if (texture == null) throw new InvalidDataException(files[frame] + " must be imported as a texture");
                if (array == null) array = Empty(texture.width, texture.height, files.Length, texture.format);
                Graphics.CopyTexture(texture, 0, 0, array, frame, 0);
            }
            return array;
        }

        private static Texture2DArray Empty(int width, int height, int frames, TextureFormat format)
        {
            return new Texture2DArray(width, height, frames, format, false, true)
            {
                wrapMode = TextureWrapMode.Repeat,
                filterMode = FilterMode.Bilinear,
            };
        }

        private static void Save(Texture2DArray array, string beside)
        {
            var path = Path.ChangeExtension(beside, null).Replace('\\', '/') + "_frames.asset";
            AssetDatabase.CreateAsset(array, path);
            Debug.Log("fftocean: " + path + ", " + array.depth + " frames");
        }
    }
}
#endif
