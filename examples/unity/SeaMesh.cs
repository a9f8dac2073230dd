// Not run in Unity: compiled against stubs of the classes that it uses.
using UnityEngine;
using UnityEngine.Rendering;

namespace FFTocean
{
    // A flat disc of rings around the camera whose spacing grows with the distance.
    public static class SeaMesh
    {
        /// <summary>Rings from `inner` to `outer` [m]; uv.x is the spacing of the vertices [m].</summary>
        public static Mesh Rings(float inner, float outer, int spokes)
        {
            float growth = 1f + 2f * Mathf.PI / spokes; // cells are squares
            int rings = 2 + Mathf.CeilToInt(Mathf.Log(outer / inner) / Mathf.Log(growth));
            var vertices = new Vector3[rings * spokes + 1];
            var spacing = new Vector2[vertices.Length];
            var triangles = new int[3 * spokes + 6 * spokes * (rings - 1)];
            spacing[vertices.Length - 1] = new Vector2(inner, 0f);
            for (int ring = 0, at = 0; ring < rings; ring++)
            {
                float radius = inner * Mathf.Pow(growth, ring);
                for (int spoke = 0; spoke < spokes; spoke++)
                {
                    float angle = 2f * Mathf.PI * spoke / spokes;
                    int here = ring * spokes + spoke, next = ring * spokes + (spoke + 1) % spokes;
                    vertices[here] = new Vector3(radius * Mathf.Cos(angle), 0f, radius * Mathf.Sin(angle));
                    spacing[here] = new Vector2(radius * (growth - 1f), 0f);
                    int[] corners = ring == 0
                        ? new[] { vertices.Length - 1, next, here }
                        : new[] { here - spokes, next - spokes, here, here, next - spokes, next };
                    foreach (int corner in corners) triangles[at++] = corner;
                }
            }
            var mesh = new Mesh { name = "Sea", indexFormat = IndexFormat.UInt32 };
            mesh.vertices = vertices;
            mesh.uv = spacing;
            mesh.triangles = triangles;
            mesh.bounds = new Bounds(Vector3.zero, new Vector3(2f * outer, 100f, 2f * outer));
            return mesh;
        }
    }
}
