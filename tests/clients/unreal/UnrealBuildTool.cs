// The names of UnrealBuildTool that examples/unreal uses.
using System.Collections.Generic;

namespace UnrealBuildTool
{
    public class ReadOnlyTargetRules { }
    public class RuntimeDependencyList { public void Add(string path) { } }
    public class ModuleRules
    {
        public enum PCHUsageMode { UseExplicitOrSharedPCHs }
        public ModuleRules(ReadOnlyTargetRules target) { }
        public PCHUsageMode PCHUsage { get; set; }
        public bool bEnableExceptions { get; set; }
        public string PluginDirectory => "";
        public List<string> PublicDependencyModuleNames = new List<string>(), PrivateDependencyModuleNames = new List<string>();
        public List<string> PublicIncludePaths = new List<string>();
        public RuntimeDependencyList RuntimeDependencies = new RuntimeDependencyList();
    }
}
