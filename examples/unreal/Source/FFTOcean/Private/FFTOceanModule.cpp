// Not run in Unreal: compiled against stubs of the classes that it uses.
#include "Interfaces/IPluginManager.h"
#include "Modules/ModuleManager.h"
#include "ShaderCore.h"

class FFFTOceanModule : public IModuleInterface
{
public:
	virtual void StartupModule() override
	{
		// Sea.usf and fftocean.ush lie beside sea.json.
		const FString Folder = IPluginManager::Get().FindPlugin(TEXT("FFTOcean"))->GetBaseDir();
		AddShaderSourceDirectoryMapping(TEXT("/FFTOcean"), Folder);
	}
};

IMPLEMENT_MODULE(FFFTOceanModule, FFTOcean)
