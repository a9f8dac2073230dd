// The few names of Unity's editor that FFToceanBakeImport.cs uses, for a C# compiler without Unity: signatures alone, after its manual.
using System;

namespace UnityEngine
{
    public enum FilterMode { Point, Bilinear, Trilinear }
    public enum TextureWrapMode { Repeat, Clamp }
    public enum TextureFormat { RGBAHalf, RGBAFloat }

    public class Object { public string name; }

    public class Texture : Object
    {
        public int width, height;
        public FilterMode filterMode;
        public TextureWrapMode wrapMode;
    }

    public class Texture2D : Texture { public TextureFormat format; }

    public class Texture2DArray : Texture
    {
        public int depth;
        public Texture2DArray(int width, int height, int depth, TextureFormat format, bool mipChain, bool linear) { this.depth = depth; }
        public void SetPixelData<T>(T[] data, int mipLevel, int element, int sourceDataStartIndex = 0) { }
        public void Apply(bool updateMipmaps = true, bool makeNoLongerReadable = false) { }
    }

    public static class Graphics
    {
        public static void CopyTexture(Texture src, int srcElement, int srcMip, Texture dst, int dstElement, int dstMip) { }
    }

    public static class Debug { public static void Log(object message) { } }
}

namespace UnityEditor
{
    using UnityEngine;

    public enum TextureImporterType { Default, NormalMap }
    public enum TextureImporterAlphaSource { None, FromInput }
    public enum TextureImporterNPOTScale { None, ToNearest }
    public enum TextureImporterShape { Texture2D, TextureCube, Texture2DArray }
    public enum TextureImporterFormat { RGBAHalf, RGBAFloat }

    public class TextureImporterSettings
    {
        public TextureImporterType textureType;
        public TextureImporterShape textureShape;
        public int flipbookColumns, flipbookRows;
        public bool sRGBTexture, alphaIsTransparency, mipmapEnabled, readable;
        public TextureImporterAlphaSource alphaSource;
        public TextureImporterNPOTScale npotScale;
        public TextureWrapMode wrapMode;
        public FilterMode filterMode;
    }

    public class TextureImporterPlatformSettings
    {
        public TextureImporterFormat format;
        public int maxTextureSize;
    }

    public class AssetImporter { }

    public class TextureImporter : AssetImporter
    {
        public void ReadTextureSettings(TextureImporterSettings dest) { }
        public void SetTextureSettings(TextureImporterSettings src) { }
        public TextureImporterPlatformSettings GetDefaultPlatformTextureSettings() { return new TextureImporterPlatformSettings(); }
        public void SetPlatformTextureSettings(TextureImporterPlatformSettings settings) { }
    }

    public class AssetPostprocessor
    {
        public string assetPath;
        public AssetImporter assetImporter;
    }

    public class MenuItem : Attribute { public MenuItem(string itemName) { } }

    public static class Selection { public static Object activeObject; }

    public static class AssetDatabase
    {
        public static string GetAssetPath(Object asset) { return ""; }
        public static T LoadAssetAtPath<T>(string path) where T : Object { return null; }
        public static void CreateAsset(Object asset, string path) { }
        public static void SaveAssets() { }
    }
}
