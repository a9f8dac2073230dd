// Not run in Unreal: compiled against stubs of the classes that it uses.
#pragma once
#include "GlobalShader.h"
#include "RenderGraphBuilder.h"
#include "RenderGraphUtils.h"
#include "SeaLayout.h"
#include "ShaderParameterStruct.h"

// What changes from frame to frame.
struct FSeaMoment
{
	uint32 Tick = 0;
	float Choppiness = 1.f;
	FIntPoint Corner{0, 0}, CornerBefore{0, 0}; // first cell of the window of foam
	FVector2f CornerPlace{0.f, 0.f}; // of its middle [m]
	float Cell = 1.f, Seconds = 0.f;
	uint32 FoamSide = 0;
};

// The buffers of a sea on the graphics processor. Used on the render thread alone.
class FSeaKernels
{
public:
	explicit FSeaKernels(FSeaLayout InLayout) : Layout(MoveTemp(InLayout)) {}

	// Evolve and transform all tiles; copy each plane to its render target, with all its levels.
	void Run(FRDGBuilder& Graph, const FSeaMoment& Moment, const TArray<FTextureRHIRef>& Planes);

private:
	FSeaLayout Layout;
	TRefCountPtr<FRDGPooledBuffer> Table, H0, Wave, Twiddle, Work, Maps;
};
