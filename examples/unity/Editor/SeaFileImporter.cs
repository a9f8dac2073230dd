// Not run in Unity: compiled against stubs of the classes that it uses.
using System.IO;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace FFTocean
{
    // Imports tile<i>.waves as assets that a SeaSurface takes.
    [ScriptedImporter(1, "waves")]
    public sealed class SeaFileImporter : ScriptedImporter
    {
        public override void OnImportAsset(AssetImportContext context)
        {
            var file = ScriptableObject.CreateInstance<SeaFile>();
            file.bytes = File.ReadAllBytes(context.assetPath);
            context.AddObjectToAsset("waves", file);
            context.SetMainObject(file);
        }
    }
}
