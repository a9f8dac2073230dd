// The names of Unity that examples/unity uses, for a C# compiler without Unity. Nothing here does anything.
using System;

namespace UnityEngine
{
    public class Object { public string name; }
    public class ScriptableObject : Object { public static T CreateInstance<T>() where T : ScriptableObject, new() => new T(); }
    public class TextAsset : Object { public byte[] bytes => null; }
    public class Component : Object
    {
        public Transform transform => null;
        public T GetComponent<T>() => default(T);
    }
    public class MonoBehaviour : Component { }
    public class Transform : Component
    {
        public Vector3 position { get; set; }
        public Vector3 TransformPoint(Vector3 point) => point;
    }
    public class Camera : Component { public static Camera main => null; }
    public class MeshFilter : Component { public Mesh sharedMesh { get; set; } }
    public class MeshRenderer : Component { }
    public class Rigidbody : Component
    {
        public float mass { get; set; }
        public Vector3 GetPointVelocity(Vector3 place) => place;
        public void AddForceAtPosition(Vector3 force, Vector3 place) { }
    }
    public static class Physics { public static Vector3 gravity => default(Vector3); }
    public static class Time { public static double timeAsDouble => 0; }
    public sealed class RequireComponent : Attribute { public RequireComponent(Type one) { } public RequireComponent(Type one, Type two) { } }
    public sealed class TooltipAttribute : Attribute { public TooltipAttribute(string words) { } }
    public sealed class HideInInspector : Attribute { }
    public struct Vector2
    {
        public float x, y;
        public Vector2(float x, float y) { this.x = x; this.y = y; }
    }
    public struct Vector2Int
    {
        public Vector2Int(int x, int y) { this.x = x; this.y = y; }
        public int x { get; set; }
        public int y { get; set; }
        public static Vector2Int operator +(Vector2Int a, Vector2Int b) => a;
    }
    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
        public static Vector3 zero => default(Vector3);
        public static Vector3 up => default(Vector3);
        public static float Dot(Vector3 a, Vector3 b) => 0;
        public static Vector3 operator *(float a, Vector3 b) => b;
        public static Vector3 operator -(Vector3 a, Vector3 b) => a;
    }
    public struct Vector4 { public Vector4(float x, float y, float z, float w) { } }
    public struct Bounds { public Bounds(Vector3 centre, Vector3 size) { } }
    public static class Mathf
    {
        public const float PI = 3.14159265f;
        public static int FloorToInt(float x) => 0;
        public static int CeilToInt(float x) => (int)Math.Ceiling(x);
        public static float Log(float x) => (float)Math.Log(x);
        public static float Pow(float x, float y) => (float)Math.Pow(x, y);
        public static float Cos(float x) => (float)Math.Cos(x);
        public static float Sin(float x) => (float)Math.Sin(x);
        public static float Clamp01(float x) => x;
    }
    public class Mesh : Object
    {
        public Rendering.IndexFormat indexFormat { get; set; }
        public Vector3[] vertices { get; set; }
        public Vector2[] uv { get; set; }
        public int[] triangles { get; set; }
        public Bounds bounds { get; set; }
    }
    public class Texture : Object
    {
        public int width => 0;
        public int height => 0;
        public TextureWrapMode wrapMode { get; set; }
        public FilterMode filterMode { get; set; }
        public int anisoLevel { get; set; }
    }
    public enum TextureWrapMode { Repeat }
    public enum FilterMode { Trilinear }
    public enum RenderTextureFormat { ARGBHalf }
    public enum RenderTextureReadWrite { Linear }
    public enum ComputeBufferType { Constant }
    public class RenderTexture : Texture
    {
        public RenderTexture(int width, int height, int depth, RenderTextureFormat format, RenderTextureReadWrite colour) { }
        public bool enableRandomWrite { get; set; }
        public bool useMipMap { get; set; }
        public bool autoGenerateMips { get; set; }
        public bool Create() => true;
        public void Release() { }
        public void GenerateMips() { }
    }
    public class ComputeBuffer
    {
        public ComputeBuffer(int count, int stride) { }
        public ComputeBuffer(int count, int stride, ComputeBufferType type) { }
        public void SetData(Array data) { }
        public void Release() { }
    }
    public class ComputeShader : Object
    {
        public int FindKernel(string name) => 0;
        public void SetConstantBuffer(string name, ComputeBuffer buffer, int offset, int size) { }
        public void SetBuffer(int kernel, string name, ComputeBuffer buffer) { }
        public void SetTexture(int kernel, string name, Texture texture, int level) { }
        public void Dispatch(int kernel, int x, int y, int z) { }
    }
    public static class Shader
    {
        public static void SetGlobalTexture(string name, Texture texture) { }
        public static void SetGlobalVector(string name, Vector4 value) { }
    }
}

namespace UnityEngine.Rendering
{
    public enum IndexFormat { UInt32 }
}

namespace UnityEditor.AssetImporters
{
    public sealed class ScriptedImporterAttribute : Attribute { public ScriptedImporterAttribute(int version, string ending) { } }
    public class AssetImportContext
    {
        public string assetPath => null;
        public void AddObjectToAsset(string name, UnityEngine.Object one) { }
        public void SetMainObject(UnityEngine.Object one) { }
    }
    public abstract class ScriptedImporter { public abstract void OnImportAsset(AssetImportContext context); }
}
