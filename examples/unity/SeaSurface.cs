// Not run in Unity: compiled against stubs of the classes that it uses. README.unity.md has ten steps.
using System;
using System.Linq;
using UnityEngine;

namespace FFTocean
{
    // Runs the sea of a package: evolves and transforms all tiles on the graphics processor, gives the
    // maps to every shader, and answers for heights on the CPU. Unity's x is east, y up, z north.
    [RequireComponent(typeof(MeshFilter), typeof(MeshRenderer))]
    public sealed class SeaSurface : MonoBehaviour
    {
        public const int MostTiles = 4; // of SeaWater.hlsl

        [Tooltip("sea.json of the package")] public TextAsset document;
        [Tooltip("tile0.waves, tile1.waves, ... of the package")] public SeaFile[] waves;
        [Tooltip("Sea.compute")] public ComputeShader kernels;
        [Tooltip("None: the main camera")] public Camera viewer;
        [Tooltip("Strongest waves that heights on the CPU sum")] public int strongest = 400;
        [Tooltip("Cells a side of the window of foam, a power of two; 0: no foam")]
        public int foamCells = 1 << 8;
        [Tooltip("Side of a cell of foam [m]")] public float foamCell = 1f;
        [Tooltip("Distance to the edge of the mesh [m]")] public float reach = 4000f;

        private static readonly string[] Names = { "_SeaMoved", "_SeaSlopes", "_SeaMoments" };

        private SeaWaves quick;
        private SeaPackage sea;
        private byte[] block;
        private ComputeBuffer constants, target, h0, wave, twiddle, work, maps;
        private RenderTexture[] planes;
        private int rows, columns, textures, foam;
        private Vector2Int corner;
        private double lastTime = double.NegativeInfinity;

        /// <summary>The waves that heights are summed of; NeglectedRms is what they leave out.</summary>
        public SeaWaves Waves => quick;

        /// <summary>The moment that is shown [s].</summary>
        public double Now => Time.timeAsDouble;

        /// <summary>The water above a place of the world: its height and its normal.</summary>
        public float HeightAt(Vector3 place, out Vector3 normal)
        {
            SeaWaves.Water water = quick.At(place.x, place.z, Now);
            normal = new Vector3((float)water.Nx, (float)water.Nz, (float)water.Ny);
            return transform.position.y + (float)water.Height;
        }

        private byte[] Read(string name)
        {
            if (name == "sea.json") return document != null ? document.bytes : null;
            SeaFile file = waves.FirstOrDefault(one => one != null && one.name + ".waves" == name);
            return file != null ? file.bytes : null;
        }

        private void OnEnable()
        {
            sea = new SeaPackage(new SeaWaves(Read));
            quick = new SeaWaves(Read, strongest);
            if (sea.Tiles.Length > MostTiles)
                throw new NotSupportedException($"SeaWater.hlsl has {MostTiles} tiles at most");
            rows = kernels.FindKernel("rows");
            columns = kernels.FindKernel("columns");
            textures = kernels.FindKernel("textures");
            foam = kernels.FindKernel("foam");
            block = sea.Block();
            constants = new ComputeBuffer(block.Length / 16, 16, ComputeBufferType.Constant);
            target = new ComputeBuffer(1, 16, ComputeBufferType.Constant);
            h0 = Filled(sea.H0, 4);
            wave = Filled(sea.Wave, 2);
            twiddle = Filled(sea.Twiddle, 2);
            work = new ComputeBuffer(2 * sea.Texels, 16);
            maps = new ComputeBuffer(sea.MapTexels + foamCells * foamCells, 16);
            planes = new RenderTexture[3 * sea.Tiles.Length + (foamCells > 0 ? 1 : 0)];
            for (int i = 0; i < planes.Length; i++)
                planes[i] = i < 3 * sea.Tiles.Length
                    ? Plane(sea.Tiles[i / 3].Nx, sea.Tiles[i / 3].Ny) : Plane(foamCells, foamCells);
            kernels.SetConstantBuffer("Sea", constants, 0, block.Length);
            kernels.SetConstantBuffer("Target", target, 0, 16);
            kernels.SetBuffer(columns, "maps", maps);
            kernels.SetBuffer(textures, "maps", maps);
            kernels.SetBuffer(foam, "maps", maps);
            kernels.SetBuffer(rows, "h0", h0);
            kernels.SetBuffer(rows, "wave", wave);
            kernels.SetBuffer(rows, "twiddle", twiddle);
            kernels.SetBuffer(rows, "work", work);
            kernels.SetBuffer(columns, "twiddle", twiddle);
            kernels.SetBuffer(columns, "work", work);
            GetComponent<MeshFilter>().sharedMesh = SeaMesh.Rings(0.4f, reach, 360);
        }

        private void OnDisable()
        {
            foreach (ComputeBuffer one in new[] { constants, target, h0, wave, twiddle, work, maps })
                if (one != null) one.Release();
            foreach (RenderTexture plane in planes ?? new RenderTexture[0]) plane.Release();
        }

        private static ComputeBuffer Filled(float[] numbers, int channels)
        {
            var buffer = new ComputeBuffer(numbers.Length / channels, 4 * channels);
            buffer.SetData(numbers);
            return buffer;
        }

        private static RenderTexture Plane(int width, int height)
        {
            var plane = new RenderTexture(width, height, 0, RenderTextureFormat.ARGBHalf,
                RenderTextureReadWrite.Linear)
            {
                enableRandomWrite = true, useMipMap = true, autoGenerateMips = false,
                wrapMode = TextureWrapMode.Repeat, filterMode = FilterMode.Trilinear, anisoLevel = 8,
            };
            plane.Create();
            return plane;
        }

        private void LateUpdate()
        {
            Camera camera = viewer != null ? viewer : Camera.main;
            Vector3 eye = camera != null ? camera.transform.position : Vector3.zero;
            transform.position = new Vector3(eye.x, transform.position.y, eye.z);
            // The loop is a whole number of ticks: a phase is exact for ever.
            double turn = Now / quick.Loop - Math.Floor(Now / quick.Loop);
            SeaPackage.Put(block, 0, (int)(turn * sea.Ticks) & (sea.Ticks - 1));
            SeaPackage.Put(block, 20, (float)quick.Choppiness);
            MoveFoam(eye);
            constants.SetData(block);
            int groups = sea.Tiles.Max(tile => Math.Max(1, tile.Nx * tile.Ny / SeaPackage.MostSide));
            kernels.Dispatch(rows, groups, sea.Tiles.Length, 1);
            kernels.Dispatch(columns, groups, sea.Tiles.Length, 1);
            int cells = (foamCells + 7) / 8;
            if (foamCells > 0) kernels.Dispatch(foam, cells, cells, 1);
            for (int i = 0; i < planes.Length; i++)
            {
                target.SetData(new[] { i, 0, 0, 0 });
                kernels.SetTexture(textures, "image", planes[i], 0);
                kernels.Dispatch(textures, (planes[i].width + 7) / 8, (planes[i].height + 7) / 8, 1);
                planes[i].GenerateMips();
            }
            Publish(eye);
        }

        // The window of foam follows the camera by whole cells; a cell keeps its texel.
        private void MoveFoam(Vector3 eye)
        {
            var now = new Vector2Int(Mathf.FloorToInt(eye.x / foamCell) - foamCells / 2,
                Mathf.FloorToInt(eye.z / foamCell) - foamCells / 2);
            bool first = double.IsNegativeInfinity(lastTime);
            Vector2Int before = first ? now + new Vector2Int(1 << 20, 1 << 20) : corner;
            corner = now;
            int[] whole = { now.x, now.y, before.x, before.y };
            for (int i = 0; i < 4; i++) SeaPackage.Put(block, 32 + 4 * i, whole[i]);
            SeaPackage.Put(block, 48, (now.x + 0.5f) * foamCell);
            SeaPackage.Put(block, 52, (now.y + 0.5f) * foamCell);
            SeaPackage.Put(block, 56, foamCell);
            SeaPackage.Put(block, 60, first ? 0f : (float)Math.Min(Now - lastTime, 0.1));
            SeaPackage.Put(block, 76, foamCells);
            SeaPackage.Put(block, 80, sea.MapTexels);
            lastTime = Now;
        }

        // What SeaWater.hlsl needs; places within a tile are reduced in double precision.
        private void Publish(Vector3 eye)
        {
            for (int i = 0; i < sea.Tiles.Length; i++)
            {
                SeaPackage.Tile tile = sea.Tiles[i];
                for (int j = 0; j < 3; j++)
                    Shader.SetGlobalTexture(Names[j] + i, planes[3 * i + j]);
                double u = eye.x / tile.Lx, v = eye.z / tile.Ly;
                Shader.SetGlobalVector("_SeaTile" + i, new Vector4((float)tile.Lx, (float)tile.Ly,
                    (float)(u - Math.Floor(u) + 0.5 / tile.Nx), (float)(v - Math.Floor(v) + 0.5 / tile.Ny)));
                Shader.SetGlobalVector("_SeaTexels" + i, new Vector4(tile.Nx, tile.Ny, 0, 0));
            }
            Shader.SetGlobalVector("_SeaEye", new Vector4(eye.x, transform.position.y, eye.z,
                sea.Tiles.Length));
            float side = foamCells * foamCell;
            Shader.SetGlobalVector("_SeaFoamWindow", new Vector4(side, side > 0 ? 1 : 0, 0, 0));
            if (foamCells > 0) Shader.SetGlobalTexture("_SeaFoam", planes[planes.Length - 1]);
        }
    }
}
