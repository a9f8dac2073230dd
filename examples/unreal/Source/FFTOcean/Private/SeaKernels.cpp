// Not run in Unreal: compiled against stubs of the classes that it uses.
#include "SeaKernels.h"

BEGIN_SHADER_PARAMETER_STRUCT(FSeaParameters, )
	SHADER_PARAMETER(uint32, tick)
	SHADER_PARAMETER(uint32, mask)
	SHADER_PARAMETER(uint32, tiles)
	SHADER_PARAMETER(uint32, twiddles)
	SHADER_PARAMETER(float, turns_per_tick)
	SHADER_PARAMETER(float, choppiness)
	SHADER_PARAMETER(FIntPoint, corner)
	SHADER_PARAMETER(FIntPoint, corner_before)
	SHADER_PARAMETER(FVector2f, corner_place)
	SHADER_PARAMETER(float, cell)
	SHADER_PARAMETER(float, seconds)
	SHADER_PARAMETER(float, decay)
	SHADER_PARAMETER(float, threshold)
	SHADER_PARAMETER(float, strength)
	SHADER_PARAMETER(uint32, foam_side)
	SHADER_PARAMETER(uint32, foam_first)
	SHADER_PARAMETER(uint32, target_plane)
	SHADER_PARAMETER(uint32, target_level)
	SHADER_PARAMETER_RDG_BUFFER_SRV(StructuredBuffer<SeaTile>, table)
	SHADER_PARAMETER_RDG_BUFFER_SRV(StructuredBuffer<float4>, h0)
	SHADER_PARAMETER_RDG_BUFFER_SRV(StructuredBuffer<float2>, wave)
	SHADER_PARAMETER_RDG_BUFFER_SRV(StructuredBuffer<float2>, twiddle)
	SHADER_PARAMETER_RDG_BUFFER_UAV(RWStructuredBuffer<float4>, work)
	SHADER_PARAMETER_RDG_BUFFER_UAV(RWStructuredBuffer<float4>, maps)
	SHADER_PARAMETER_RDG_TEXTURE_UAV(RWTexture2D<float4>, image)
END_SHADER_PARAMETER_STRUCT()

#define SEA_KERNEL(Name, Entry) \
	class Name : public FGlobalShader \
	{ \
		DECLARE_GLOBAL_SHADER(Name); \
		SHADER_USE_PARAMETER_STRUCT(Name, FGlobalShader); \
		using FParameters = FSeaParameters; \
		static bool ShouldCompilePermutation(const FGlobalShaderPermutationParameters& Parameters) \
		{ \
			return IsFeatureLevelSupported(Parameters.Platform, ERHIFeatureLevel::SM5); \
		} \
	}; \
	IMPLEMENT_GLOBAL_SHADER(Name, "/FFTOcean/Sea.usf", Entry, SF_Compute);

SEA_KERNEL(FSeaRows, "rows")
SEA_KERNEL(FSeaColumns, "columns")
SEA_KERNEL(FSeaFoam, "foam")
SEA_KERNEL(FSeaMips, "mips")
SEA_KERNEL(FSeaMipsFar, "mips_far")
SEA_KERNEL(FSeaTextures, "textures")

namespace
{
uint32 Levels(uint32 Side) { return Side > 1 ? 1 + Levels(Side / 2) : 1; }

template <typename Kernel>
void Add(FRDGBuilder& Graph, const FSeaParameters& Given, FIntVector Groups)
{
	FSeaParameters* Parameters = Graph.AllocParameters<FSeaParameters>();
	*Parameters = Given;
	TShaderMapRef<Kernel> Shader(GetGlobalShaderMap(GMaxRHIFeatureLevel));
	ClearUnusedGraphResources(Shader, Parameters);
	FComputeShaderUtils::AddPass(Graph, RDG_EVENT_NAME("FFTOcean"), Shader, Parameters, Groups);
}

template <typename Element>
FRDGBufferRef Uploaded(FRDGBuilder& Graph, TRefCountPtr<FRDGPooledBuffer>& Kept, const TCHAR* Name,
	uint32 Stride, const std::vector<Element>& Data)
{
	if (Kept.IsValid()) return Graph.RegisterExternalBuffer(Kept);
	const uint32 Bytes = uint32(Data.size() * sizeof(Element));
	FRDGBufferRef Buffer = CreateStructuredBuffer(Graph, Name, Stride, Bytes / Stride, Data.data(), Bytes);
	Kept = Graph.ConvertToExternalBuffer(Buffer);
	return Buffer;
}

FRDGBufferRef Empty(FRDGBuilder& Graph, TRefCountPtr<FRDGPooledBuffer>& Kept, const TCHAR* Name,
	uint32 Count)
{
	if (Kept.IsValid()) return Graph.RegisterExternalBuffer(Kept);
	FRDGBufferRef Buffer = Graph.CreateBuffer(FRDGBufferDesc::CreateStructuredDesc(16, Count), Name);
	AddClearUAVPass(Graph, Graph.CreateUAV(Buffer), 0u);
	Kept = Graph.ConvertToExternalBuffer(Buffer);
	return Buffer;
}
} // namespace

void FSeaKernels::Run(FRDGBuilder& Graph, const FSeaMoment& Moment, const TArray<FTextureRHIRef>& Planes)
{
	FSeaParameters P{};
	P.tick = Moment.Tick;
	P.mask = Layout.Ticks - 1;
	P.tiles = uint32(Layout.Tiles.size());
	P.twiddles = uint32(Layout.Twiddle.size() / 2);
	P.turns_per_tick = 1.f / float(Layout.Ticks);
	P.choppiness = Moment.Choppiness;
	P.corner = Moment.Corner;
	P.corner_before = Moment.CornerBefore;
	P.corner_place = Moment.CornerPlace;
	P.cell = Moment.Cell;
	P.seconds = Moment.Seconds;
	P.decay = Layout.Decay;
	P.threshold = Layout.Threshold;
	P.strength = Layout.Strength;
	P.foam_side = Moment.FoamSide;
	P.foam_first = Layout.MapTexels;
	P.table = Graph.CreateSRV(Uploaded(Graph, Table, TEXT("Sea.Table"), 64, Layout.Tiles));
	P.h0 = Graph.CreateSRV(Uploaded(Graph, H0, TEXT("Sea.H0"), 16, Layout.H0));
	P.wave = Graph.CreateSRV(Uploaded(Graph, Wave, TEXT("Sea.Wave"), 8, Layout.Wave));
	P.twiddle = Graph.CreateSRV(Uploaded(Graph, Twiddle, TEXT("Sea.Twiddle"), 8, Layout.Twiddle));
	P.work = Graph.CreateUAV(Empty(Graph, Work, TEXT("Sea.Work"), 2 * Layout.Texels));
	const uint32 FoamTexels = FSeaLayout::TexelsOfLevels(FMath::Max(Moment.FoamSide, 1u), FMath::Max(Moment.FoamSide, 1u));
	P.maps = Graph.CreateUAV(Empty(Graph, Maps, TEXT("Sea.Maps"), Layout.MapTexels + FoamTexels));

	const int32 Tiles = int32(Layout.Tiles.size());
	const int32 All = 3 * Tiles + (Moment.FoamSide > 0 ? 1 : 0);
	uint32 Longest = Moment.FoamSide;
	for (const FSeaTile& Tile : Layout.Tiles) Longest = FMath::Max(Longest, FMath::Max(Tile.Nx, Tile.Ny));
	const auto Blocks = [](uint32 Side, uint32 Of) { return int32((Side + Of - 1) / Of); };
	Add<FSeaRows>(Graph, P, FIntVector(int32(Layout.Groups), Tiles, 1));
	Add<FSeaColumns>(Graph, P, FIntVector(int32(Layout.Groups), Tiles, 1));
	if (Moment.FoamSide > 0)
		Add<FSeaFoam>(Graph, P, FIntVector(Blocks(Moment.FoamSide, 8), Blocks(Moment.FoamSide, 8), 1));
	Add<FSeaMips>(Graph, P, FIntVector(Blocks(Longest, 32), Blocks(Longest, 32), All));
	Add<FSeaMipsFar>(Graph, P, FIntVector(1, 1, All));
	for (int32 Plane = 0; Plane < FMath::Min(All, Planes.Num()); Plane++)
	{
		FRDGTextureRef Texture = Graph.RegisterExternalTexture(CreateRenderTarget(Planes[Plane], TEXT("Sea.Plane")));
		const bool bFoam = Plane == 3 * Tiles;
		const uint32 Nx = bFoam ? Moment.FoamSide : Layout.Tiles[size_t(Plane) / 3].Nx;
		const uint32 Ny = bFoam ? Moment.FoamSide : Layout.Tiles[size_t(Plane) / 3].Ny;
		for (uint32 Level = 0; Level < Levels(FMath::Max(Nx, Ny)); Level++)
		{
			P.target_plane = uint32(Plane);
			P.target_level = Level;
			P.image = Graph.CreateUAV(FRDGTextureUAVDesc(Texture, uint8(Level)));
			const uint32 Width = FMath::Max(Nx >> Level, 1u), Height = FMath::Max(Ny >> Level, 1u);
			Add<FSeaTextures>(Graph, P, FIntVector(Blocks(Width, 8), Blocks(Height, 8), 1));
		}
	}
}
