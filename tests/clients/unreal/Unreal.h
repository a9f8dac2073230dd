// The names of Unreal that examples/unreal uses, for a compiler without Unreal. Nothing here does anything.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

using uint8 = std::uint8_t;
using uint32 = std::uint32_t;
using int32 = std::int32_t;
using TCHAR = char16_t;
#define TEXT(words) u##words
#define TCHAR_TO_UTF8(words) ((void)(words), "")
#define UTF8_TO_TCHAR(words) ((void)(words), u"")
#define check(condition) ((void)(condition)) // a macro of Unreal's that other names must not meet
#define verify(condition) ((void)(condition))
#define UCLASS(...)
#define UPROPERTY(...)
#define UFUNCTION(...)
#define GENERATED_BODY() using Super = UActorComponent;
#define FFTOCEAN_API
#define UE_LOG(category, level, ...) ((void)sizeof(Formatted(__VA_ARGS__)))
template <typename... T> int Formatted(T&&...);
template <typename T> std::remove_reference_t<T>&& MoveTemp(T&& one) { return std::move(one); }

template <typename T> struct TArray : private std::vector<T> {
    TArray() = default;
    template <typename U> TArray(const TArray<U>&) {}
    void Add(const T& one) { this->push_back(one); }
    int32 Num() const { return int32(this->size()); }
    T& operator[](int32 i) { return std::vector<T>::operator[](std::size_t(i)); }
    const T& operator[](int32 i) const { return std::vector<T>::operator[](std::size_t(i)); }
    using std::vector<T>::begin;
    using std::vector<T>::end;
};
template <typename T> struct TObjectPtr {
    T* one = nullptr;
    TObjectPtr& operator=(T* other) { one = other; return *this; }
    TObjectPtr() = default;
    TObjectPtr(T* other) : one(other) {}
    operator T*() const { return one; }
    T* operator->() const { return one; }
};
template <typename T> struct TSharedPtr { T* operator->() const { return nullptr; } };
template <typename T> struct TRefCountPtr { bool IsValid() const { return false; } };

struct FString {
    FString() = default;
    explicit FString(const TCHAR*) {}
    static FString FromInt(int32) { return {}; }
    const TCHAR* operator*() const { return u""; }
    FString operator+(const FString&) const { return {}; }
};
struct FName { FName(const TCHAR*) {} };
struct FVector { double X = 0, Y = 0, Z = 0; FVector(double, double, double) {} };
struct FVector2f { float X, Y; FVector2f() = default; FVector2f(float x, float y) : X(x), Y(y) {} };
struct FIntPoint {
    int32 X = 0, Y = 0;
    FIntPoint() = default;
    FIntPoint(int32 x, int32 y) : X(x), Y(y) {}
    FIntPoint operator+(const FIntPoint& other) const { return other; }
};
struct FIntVector { FIntVector(int32, int32, int32) {} };
struct FLinearColor { FLinearColor(float, float, float, float) {} };
struct FMath {
    template <typename T> static T Max(T a, T b) { return a > b ? a : b; }
    template <typename T> static T Min(T a, T b) { return a < b ? a : b; }
    static double FloorToDouble(double x) { return std::floor(x); }
    static int32 FloorToInt32(double x) { return int32(std::floor(x)); }
};

// objects
namespace EEndPlayReason { enum Type { Quit }; }
enum ELevelTick { LEVELTICK_All };
enum { RTF_RGBA16f, TA_Wrap };
struct FActorComponentTickFunction { bool bCanEverTick = false; };
struct FTextureRHIRef {};
struct FTextureRenderTargetResource { FTextureRHIRef GetRenderTargetTexture() { return {}; } };
class UObject {};
class UMaterialInterface : public UObject {};
class UTexture : public UObject {};
class UTextureRenderTarget2D : public UTexture {
public:
    int RenderTargetFormat = 0, AddressX = 0, AddressY = 0;
    bool bCanCreateUAV = false, bAutoGenerateMips = false;
    void InitAutoFormat(uint32, uint32) {}
    void UpdateResourceImmediate(bool) {}
    FTextureRenderTargetResource* GameThread_GetRenderTargetResource() { return nullptr; }
};
class UMaterialInstanceDynamic : public UMaterialInterface {
public:
    static UMaterialInstanceDynamic* Create(UMaterialInterface*, UObject*) { return nullptr; }
    void SetTextureParameterValue(FName, UTexture*) {}
    void SetVectorParameterValue(FName, FLinearColor) {}
};
class UMeshComponent : public UObject {
public:
    void SetMaterial(int32, UMaterialInterface*) {}
};
class UWorld { public: double GetTimeSeconds() const { return 0; } };
class AActor : public UObject {
public:
    template <typename T> void GetComponents(TArray<T*>&) {}
    FVector GetActorLocation() const { return {0, 0, 0}; }
};
class UActorComponent : public UObject {
public:
    FActorComponentTickFunction PrimaryComponentTick;
    virtual ~UActorComponent() = default;
    virtual void BeginPlay() {}
    virtual void EndPlay(const EEndPlayReason::Type) {}
    virtual void TickComponent(float, ELevelTick, FActorComponentTickFunction*) {}
    UWorld* GetWorld() const { return nullptr; }
    AActor* GetOwner() const { return nullptr; }
};
class APlayerCameraManager { public: FVector GetCameraLocation() const { return {0, 0, 0}; } };
struct UGameplayStatics { static APlayerCameraManager* GetPlayerCameraManager(const UObject*, int32) { return nullptr; } };
template <typename T> T* NewObject(UObject*) { return nullptr; }

// modules
struct IPlugin { FString GetBaseDir() const { return {}; } };
struct IPluginManager {
    static IPluginManager& Get() { static IPluginManager one; return one; }
    TSharedPtr<IPlugin> FindPlugin(const TCHAR*) { return {}; }
};
struct IModuleInterface { virtual ~IModuleInterface() = default; virtual void StartupModule() {} };
inline void AddShaderSourceDirectoryMapping(const FString&, const FString&) {}
inline void AddShaderSourceDirectoryMapping(const TCHAR*, const FString&) {}
#define IMPLEMENT_MODULE(Class, Name) static Class Name##Module;

// shaders and the render graph
struct FRHICommandListImmediate {};
struct FRDGPooledBuffer {};
struct FRDGBuffer {};
struct FRDGTexture {};
struct FRDGBufferSRV {};
struct FRDGBufferUAV {};
struct FRDGTextureUAV {};
using FRDGBufferRef = FRDGBuffer*;
using FRDGTextureRef = FRDGTexture*;
struct FRDGBufferDesc { static FRDGBufferDesc CreateStructuredDesc(uint32, uint32) { return {}; } };
struct FRDGTextureUAVDesc { FRDGTextureUAVDesc(FRDGTextureRef, uint8) {} };
struct IPooledRenderTarget {};
inline TRefCountPtr<IPooledRenderTarget> CreateRenderTarget(const FTextureRHIRef&, const TCHAR*) { return {}; }
struct FRDGBuilder {
    FRDGBuilder() = default;
    explicit FRDGBuilder(FRHICommandListImmediate&) {}
    template <typename T> T* AllocParameters() { return nullptr; }
    FRDGBufferRef RegisterExternalBuffer(const TRefCountPtr<FRDGPooledBuffer>&) { return nullptr; }
    FRDGTextureRef RegisterExternalTexture(const TRefCountPtr<IPooledRenderTarget>&) { return nullptr; }
    TRefCountPtr<FRDGPooledBuffer> ConvertToExternalBuffer(FRDGBufferRef) { return {}; }
    FRDGBufferRef CreateBuffer(const FRDGBufferDesc&, const TCHAR*) { return nullptr; }
    FRDGBufferSRV* CreateSRV(FRDGBufferRef) { return nullptr; }
    FRDGBufferUAV* CreateUAV(FRDGBufferRef) { return nullptr; }
    FRDGTextureUAV* CreateUAV(const FRDGTextureUAVDesc&) { return nullptr; }
    void Execute() {}
};
inline FRDGBufferRef CreateStructuredBuffer(FRDGBuilder&, const TCHAR*, uint32, uint32, const void*, uint32) { return nullptr; }
inline void AddClearUAVPass(FRDGBuilder&, FRDGBufferUAV*, uint32) {}
struct FShaderType {};
class FGlobalShader {};
struct FGlobalShaderMap {};
enum EShaderPlatform { SP_PCD3D_SM6 };
namespace ERHIFeatureLevel { enum Type { SM5 }; }
struct FGlobalShaderPermutationParameters { EShaderPlatform Platform; };
inline bool IsFeatureLevelSupported(EShaderPlatform, ERHIFeatureLevel::Type) { return true; }
inline FGlobalShaderMap* GetGlobalShaderMap(int) { return nullptr; }
static const int GMaxRHIFeatureLevel = 0;
template <typename T> struct TShaderMapRef { explicit TShaderMapRef(FGlobalShaderMap*) {} };
template <typename T, typename P> void ClearUnusedGraphResources(const TShaderMapRef<T>&, P*) {}
struct FComputeShaderUtils {
    template <typename T, typename P>
    static void AddPass(FRDGBuilder&, int, const TShaderMapRef<T>&, P*, const FIntVector&) {}
};
#define RDG_EVENT_NAME(words) ((void)words, 0)
#define BEGIN_SHADER_PARAMETER_STRUCT(Name, Prefix) struct Name {
#define END_SHADER_PARAMETER_STRUCT() };
#define SHADER_PARAMETER(Type, Name) Type Name;
#define SHADER_PARAMETER_RDG_BUFFER_SRV(Type, Name) FRDGBufferSRV* Name;
#define SHADER_PARAMETER_RDG_BUFFER_UAV(Type, Name) FRDGBufferUAV* Name;
#define SHADER_PARAMETER_RDG_TEXTURE_UAV(Type, Name) FRDGTextureUAV* Name;
#define DECLARE_GLOBAL_SHADER(Name) static FShaderType StaticType
#define SHADER_USE_PARAMETER_STRUCT(Name, Base) static_assert(sizeof(Base) > 0, "")
#define IMPLEMENT_GLOBAL_SHADER(Name, File, Entry, Frequency) static_assert(sizeof(File Entry) > 0, "")
template <typename F> void Enqueue(F&&) {}
struct Enqueuer { template <typename F> void operator()(F&&) const {} };
#define ENQUEUE_RENDER_COMMAND(Name) Enqueuer()
