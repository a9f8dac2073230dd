// Not run in Unreal: compiled against stubs of the classes that it uses.
#include "SeaComponent.h"

#include "Camera/PlayerCameraManager.h"
#include "Components/MeshComponent.h"
#include "Engine/TextureRenderTarget2D.h"
#include "Engine/World.h"
#include "GameFramework/Actor.h"
#include "Interfaces/IPluginManager.h"
#include "Kismet/GameplayStatics.h"
#include "Materials/MaterialInstanceDynamic.h"
#include "RenderingThread.h"
#include "SeaKernels.h"
#include "TextureResource.h"

namespace
{
constexpr double Centimetres = 100.0; // in a metre
const TCHAR* const Kinds[] = {TEXT("Moved"), TEXT("Slopes"), TEXT("Moments")};

FName Numbered(const TCHAR* Name, int32 Index) { return FName(*(FString(Name) + FString::FromInt(Index))); }
} // namespace

USeaComponent::USeaComponent() { PrimaryComponentTick.bCanEverTick = true; }

void USeaComponent::BeginPlay()
{
	Super::BeginPlay();
	const FString Folder = IPluginManager::Get().FindPlugin(TEXT("FFTOcean"))->GetBaseDir();
	const std::string Path(TCHAR_TO_UTF8(*Folder));
	try
	{
		const fftocean::SeaWaves Sea(Path);
		FSeaLayout Layout(Sea);
		Ticks = Layout.Ticks;
		Sizes = Sea.sizes;
		for (const FSeaTile& Tile : Layout.Tiles)
		{
			Samples.push_back({Tile.Nx, Tile.Ny});
			for (int32 Kind = 0; Kind < 3; Kind++) Planes.Add(NewPlane(Tile.Nx, Tile.Ny));
		}
		if (FoamCells > 0) Planes.Add(NewPlane(uint32(FoamCells), uint32(FoamCells)));
		Quick = std::make_unique<fftocean::SeaWaves>(Path, size_t(FMath::Max(Strongest, 0)));
		Kernels = std::make_shared<FSeaKernels>(MoveTemp(Layout));
	}
	catch (const fftocean::SeaError& Error)
	{
		UE_LOG(LogTemp, Error, TEXT("fftocean: %s"), UTF8_TO_TCHAR(Error.what()));
		return;
	}
	if (Material == nullptr) return;
	Instance = UMaterialInstanceDynamic::Create(Material, this);
	TArray<UMeshComponent*> Meshes;
	GetOwner()->GetComponents(Meshes);
	for (UMeshComponent* Mesh : Meshes) Mesh->SetMaterial(0, Instance);
	for (size_t i = 0; i < Sizes.size(); i++)
		for (int32 Kind = 0; Kind < 3; Kind++)
			Instance->SetTextureParameterValue(Numbered(Kinds[Kind], int32(i)), Planes[3 * int32(i) + Kind]);
	if (FoamCells > 0) Instance->SetTextureParameterValue(TEXT("Foam"), Planes[Planes.Num() - 1]);
}

void USeaComponent::EndPlay(const EEndPlayReason::Type Reason)
{
	// The buffers are released on the thread that uses them.
	ENQUEUE_RENDER_COMMAND(FFTOceanEnd)([Last = MoveTemp(Kernels)](FRHICommandListImmediate&) {});
	Kernels.reset();
	Super::EndPlay(Reason);
}

UTextureRenderTarget2D* USeaComponent::NewPlane(uint32 Width, uint32 Height)
{
	UTextureRenderTarget2D* Plane = NewObject<UTextureRenderTarget2D>(this);
	Plane->RenderTargetFormat = RTF_RGBA16f;
	Plane->bCanCreateUAV = true;
	Plane->bAutoGenerateMips = true; // so that there are levels; the kernels fill them
	Plane->AddressX = TA_Wrap;
	Plane->AddressY = TA_Wrap;
	Plane->InitAutoFormat(Width, Height);
	Plane->UpdateResourceImmediate(true);
	return Plane;
}

double USeaComponent::Now() const { return GetWorld()->GetTimeSeconds(); }

double USeaComponent::HeightAt(FVector Place, FVector& Normal) const
{
	Normal = FVector(0.0, 0.0, 1.0);
	const double Level = GetOwner()->GetActorLocation().Z;
	if (!Quick) return Level;
	const fftocean::Water Water = Quick->at(Place.X / Centimetres, -Place.Y / Centimetres, Now());
	Normal = FVector(Water.normal[0], -Water.normal[1], Water.normal[2]);
	return Level + Centimetres * Water.height;
}

double USeaComponent::NeglectedRms() const { return Quick ? Centimetres * Quick->neglected_rms : 0.0; }

void USeaComponent::TickComponent(float Seconds, ELevelTick Kind, FActorComponentTickFunction* Function)
{
	Super::TickComponent(Seconds, Kind, Function);
	if (!Kernels) return;
	FVector Eye(0.0, 0.0, 0.0);
	if (const APlayerCameraManager* Camera = UGameplayStatics::GetPlayerCameraManager(this, 0))
		Eye = Camera->GetCameraLocation();
	FSeaMoment Moment;
	const double Loops = Now() / Quick->loop;
	Moment.Tick = uint32((Loops - FMath::FloorToDouble(Loops)) * Ticks) & (Ticks - 1);
	Moment.Choppiness = float(Quick->choppiness);
	Moment.Cell = float(FoamCell / Centimetres);
	Moment.FoamSide = uint32(FMath::Max(FoamCells, 0));
	Moment.Seconds = bStarted ? FMath::Min(Seconds, 0.1f) : 0.f;
	// The window follows the camera by whole cells; a cell keeps its texel. North is -Y.
	const FIntPoint First(FMath::FloorToInt32(Eye.X / FoamCell) - FoamCells / 2,
		FMath::FloorToInt32(-Eye.Y / FoamCell) - FoamCells / 2);
	Moment.CornerBefore = bStarted ? Corner : First + FIntPoint(1 << 20, 1 << 20);
	Moment.Corner = Corner = First;
	Moment.CornerPlace = FVector2f((float(First.X) + 0.5f) * Moment.Cell, (float(First.Y) + 0.5f) * Moment.Cell);
	bStarted = true;
	Publish(Eye);
	TArray<FTextureRenderTargetResource*> Resources;
	for (UTextureRenderTarget2D* Plane : Planes) Resources.Add(Plane->GameThread_GetRenderTargetResource());
	ENQUEUE_RENDER_COMMAND(FFTOceanRun)(
		[Running = Kernels, Moment, Resources](FRHICommandListImmediate& Commands)
		{
			TArray<FTextureRHIRef> Textures;
			for (FTextureRenderTargetResource* Resource : Resources) Textures.Add(Resource->GetRenderTargetTexture());
			FRDGBuilder Graph(Commands);
			Running->Run(Graph, Moment, Textures);
			Graph.Execute();
		});
}

// What SeaWater.ush needs; places within a tile are reduced in double precision.
void USeaComponent::Publish(const FVector& Eye)
{
	if (Instance == nullptr) return;
	for (size_t i = 0; i < Sizes.size(); i++)
	{
		const double U = Eye.X / Centimetres / Sizes[i][0], V = -Eye.Y / Centimetres / Sizes[i][1];
		const double Nx = Samples[i][0], Ny = Samples[i][1];
		Instance->SetVectorParameterValue(Numbered(TEXT("Tile"), int32(i)),
			FLinearColor(float(Sizes[i][0]), float(Sizes[i][1]), float(U - FMath::FloorToDouble(U) + 0.5 / Nx),
				float(V - FMath::FloorToDouble(V) + 0.5 / Ny)));
	}
	Instance->SetVectorParameterValue(TEXT("Eye"),
		FLinearColor(float(Eye.X), float(Eye.Y), float(Eye.Z), FoamCells * FoamCell));
}
