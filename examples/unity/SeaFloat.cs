// Not run in Unity: compiled against stubs of the classes that it uses.
using UnityEngine;

namespace FFTocean
{
    // Buoyancy at some points of a rigid body, by the heights that SeaSurface has on the CPU.
    [RequireComponent(typeof(Rigidbody))]
    public sealed class SeaFloat : MonoBehaviour
    {
        public SeaSurface sea;
        [Tooltip("Points of the hull, in its own axes")] public Vector3[] points = { Vector3.zero };
        [Tooltip("Depth at which a point carries twice the body's weight [m]")] public float draught = 1f;
        [Tooltip("Damping of motion through the water [1/s]")] public float drag = 1f;

        private Rigidbody body;

        private void Awake() => body = GetComponent<Rigidbody>();

        private void FixedUpdate()
        {
            float share = body.mass / points.Length;
            foreach (Vector3 point in points)
            {
                Vector3 place = transform.TransformPoint(point), normal;
                float depth = sea.HeightAt(place, out normal) - place.y;
                float wet = Mathf.Clamp01(depth / draught);
                Vector3 lift = -2f * share * wet * Vector3.Dot(Physics.gravity, Vector3.up) * normal;
                body.AddForceAtPosition(lift - drag * share * wet * body.GetPointVelocity(place), place);
            }
        }
    }
}
