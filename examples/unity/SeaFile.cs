// Not run in Unity: compiled against stubs of the classes that it uses.
using UnityEngine;

namespace FFTocean
{
    // Bytes of a file tile<i>.waves, as SeaFileImporter imports it: so they are in every build.
    public sealed class SeaFile : ScriptableObject
    {
        [HideInInspector] public byte[] bytes;
    }
}
