// Not run: no Metal compiler was at hand. The same SPIR-V as that of the GLSL kernels, which are run.
// Kernel `textures` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.
// Source: fftocean.hlsl, SHA-256 87ca8ec0a5af0c2655da9827ebd1da26d3e673de82df8cb445d9f38fb417e22e
// Tools: Glslang Version: 11:12.0.0; spirv-cross 2021.01.15+1.3.239.0-1
#pragma clang diagnostic ignored "-Wmissing-prototypes"

#include <metal_stdlib>
#include <simd/simd.h>

using namespace metal;

struct Tile
{
    uint nx;
    uint ny;
    uint first;
    uint first_map;
    float2 size;
    float2 dk;
    float4 lifts;
    float2 origin;
    float2 unused;
};

struct Sea
{
    uint tick;
    uint mask;
    uint tiles;
    uint twiddles;
    float turns_per_tick;
    float choppiness;
    uint points;
    uint iterations;
    int2 corner;
    int2 corner_before;
    float2 corner_place;
    float cell;
    float seconds;
    float decay;
    float threshold;
    float strength;
    uint foam_side;
    uint foam_first;
    uint unused_0;
    uint unused_1;
    uint unused_2;
    Tile table[16];
};

struct Target
{
    uint target_plane;
    uint target_level;
    uint unused_3;
    uint unused_4;
};

struct maps
{
    float4 _data[1];
};

struct h0
{
    float4 _data[1];
};

struct wave
{
    float2 _data[1];
};

static inline __attribute__((always_inline))
uint texels_of_levels(thread const uint& nx, thread const uint& ny)
{
    uint sum = 1u;
    uint2 size = uint2(nx, ny);
    for (; (size.x * size.y) > 1u; size = max((size / uint2(2u)), uint2(1u)))
    {
        sum += (size.x * size.y);
    }
    return sum;
}

static inline __attribute__((always_inline))
uint3 plane_at(thread const uint& index, constant Sea& sea)
{
    if (index >= (3u * sea.tiles))
    {
        return uint3(sea.foam_side, sea.foam_side, sea.foam_first);
    }
    uint tile = index / 3u;
    uint nx = sea.table[tile].nx;
    uint ny = sea.table[tile].ny;
    uint param = nx;
    uint param_1 = ny;
    return uint3(nx, ny, sea.table[tile].first_map + ((index % 3u) * texels_of_levels(param, param_1)));
}

static inline __attribute__((always_inline))
uint3 next_level(thread const uint3& plane)
{
    return uint3(max((plane.xy / uint2(2u)), uint2(1u)), plane.z + (plane.x * plane.y));
}

static inline __attribute__((always_inline))
void _textures(thread const uint3& id, constant Sea& sea, constant Target& target_level, device maps& maps_1, texture2d<float, access::write> image)
{
    uint param = target_level.target_plane;
    uint3 level0 = plane_at(param, sea);
    for (uint i = 0u; i < target_level.target_level; i++)
    {
        uint3 param_1 = level0;
        level0 = next_level(param_1);
    }
    if (any(id.xy >= level0.xy))
    {
        return;
    }
    float4 storeTemp = maps_1._data[(level0.z + (id.y * level0.x)) + id.x];
    image.write(storeTemp, uint2(id.xy));
}

kernel void textures(constant Sea& sea [[buffer(0)]], device maps& maps_1 [[buffer(5)]], constant Target& target_level [[buffer(9)]], texture2d<float, access::write> image [[texture(6)]], uint3 gl_GlobalInvocationID [[thread_position_in_grid]])
{
    threadgroup float4 held[1024];
    uint3 id = gl_GlobalInvocationID;
    uint3 param = id;
    _textures(param, sea, target_level, maps_1, image);
}

