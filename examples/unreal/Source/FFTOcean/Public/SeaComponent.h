// Not run in Unreal: compiled against stubs of the classes that it uses. README.unreal.md has ten steps.
#pragma once
#include "Components/ActorComponent.h"
#include "CoreMinimal.h"
#include "sea_waves.hpp"

#include <memory>

#include "SeaComponent.generated.h"

class FSeaKernels;
class UMaterialInstanceDynamic;
class UTextureRenderTarget2D;

// Runs the sea of the package in the plugin's folder, and gives its maps to a material.
// Unreal's X is east, Y south, Z up, in centimetres.
UCLASS(ClassGroup = (FFTOcean), meta = (BlueprintSpawnableComponent))
class FFTOCEAN_API USeaComponent : public UActorComponent
{
	GENERATED_BODY()

public:
	USeaComponent();

	// The material of the water: see README.unreal.md. Its instance is given to the actor's meshes.
	UPROPERTY(EditAnywhere, Category = "Sea") TObjectPtr<class UMaterialInterface> Material;
	// Strongest waves that heights on the CPU sum.
	UPROPERTY(EditAnywhere, Category = "Sea") int32 Strongest = 400;
	// Cells a side of the window of foam, a power of two; 0: no foam.
	UPROPERTY(EditAnywhere, Category = "Sea") int32 FoamCells = 1 << 8;
	// Side of a cell of foam [cm].
	UPROPERTY(EditAnywhere, Category = "Sea") float FoamCell = 100.f;

	// The height of the water above a place of the world [cm], and its normal.
	UFUNCTION(BlueprintCallable, Category = "Sea") double HeightAt(FVector Place, FVector& Normal) const;
	// What the waves that are left out would add to heights, in the mean square [cm].
	UFUNCTION(BlueprintCallable, Category = "Sea") double NeglectedRms() const;

	virtual void BeginPlay() override;
	virtual void EndPlay(const EEndPlayReason::Type Reason) override;
	virtual void TickComponent(float Seconds, ELevelTick Kind, FActorComponentTickFunction* Function) override;

private:
	UPROPERTY() TArray<TObjectPtr<UTextureRenderTarget2D>> Planes;
	UPROPERTY() TObjectPtr<UMaterialInstanceDynamic> Instance;
	std::unique_ptr<fftocean::SeaWaves> Quick;
	std::shared_ptr<FSeaKernels> Kernels;
	std::vector<std::array<double, 2>> Sizes; // of the tiles [m]
	std::vector<std::array<uint32, 2>> Samples;
	uint32 Ticks = 2;
	FIntPoint Corner{0, 0};
	bool bStarted = false;

	double Now() const;
	UTextureRenderTarget2D* NewPlane(uint32 Width, uint32 Height);
	void Publish(const FVector& Eye);
};
