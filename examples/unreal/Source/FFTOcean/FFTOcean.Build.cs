// Not run in Unreal: compiled against stubs of the classes that it uses.
using System.IO;
using UnrealBuildTool;

public class FFTOcean : ModuleRules
{
	public FFTOcean(ReadOnlyTargetRules Target) : base(Target)
	{
		PCHUsage = PCHUsageMode.UseExplicitOrSharedPCHs;
		bEnableExceptions = true; // sea_waves.hpp refuses damaged packages by them
		PublicDependencyModuleNames.AddRange(new[] { "Core", "CoreUObject", "Engine" });
		PrivateDependencyModuleNames.AddRange(new[] { "Projects", "RenderCore", "RHI" });
		PublicIncludePaths.Add(PluginDirectory); // sea_waves.hpp, beside sea.json
		// The package goes into every build.
		RuntimeDependencies.Add(Path.Combine(PluginDirectory, "sea.json"));
		foreach (string Waves in Directory.GetFiles(PluginDirectory, "tile*.waves"))
		{
			RuntimeDependencies.Add(Waves);
		}
	}
}
