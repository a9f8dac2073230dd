// Not run: no Metal compiler was at hand. The same SPIR-V as that of the GLSL kernels, which are run.
// Kernel `foam` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.
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

struct Target
{
    uint target_plane;
    uint target_level;
    uint unused_3;
    uint unused_4;
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
void _foam(thread const uint3& id, constant Sea& sea, device maps& maps_1)
{
    uint side = sea.foam_side;
    if (any(id.xy >= uint2(side, side)))
    {
        return;
    }
    int2 own = (int2(id.xy) - sea.corner) & int2(int(side - 1u), int(side - 1u));
    float2 rest = sea.corner_place + (float2(own) * sea.cell);
    float3 stretch = float3(0.0);
    for (uint i = 0u; i < sea.tiles; i++)
    {
        uint2 n = uint2(sea.table[i].nx, sea.table[i].ny);
        uint2 nearest = uint2(floor((fract((rest / sea.table[i].size) + sea.table[i].origin) * float2(n)) + float2(0.5))) & (n - uint2(1u));
        uint texel = (sea.table[i].first_map + (nearest.y * n.x)) + nearest.x;
        uint param = n.x;
        uint param_1 = n.y;
        stretch += float3(maps_1._data[texel + texels_of_levels(param, param_1)].zw, ((device float*)&maps_1._data[texel])[3u]);
    }
    float middle = 1.0 + (0.5 * (stretch.x + stretch.y));
    float half_difference = 0.5 * (stretch.x - stretch.y);
    float now = sea.threshold - (middle - sqrt((half_difference * half_difference) + (stretch.z * stretch.z)));
    uint at = (sea.foam_first + (id.y * side)) + id.x;
    float before = ((device float*)&maps_1._data[at])[2u];
    float d = exp(((-0.25) * sea.seconds) / sea.decay);
    float made = ((((((((0.5 * d) * d) * d) * d) * fast::max(before, 0.0)) + (((d * d) * d) * fast::max(mix(before, now, 0.25), 0.0))) + ((d * d) * fast::max(mix(before, now, 0.5), 0.0))) + (d * fast::max(mix(before, now, 0.75), 0.0))) + (0.5 * fast::max(now, 0.0));
    float amount = ((((d * d) * d) * d) * ((device float*)&maps_1._data[at])[1u]) + (((0.25 * sea.seconds) * sea.strength) * made);
    int2 old = (sea.corner + own) - sea.corner_before;
    if (any(old < int2(0)) || any(old >= int2(int(side), int(side))))
    {
        amount = (sea.decay * sea.strength) * fast::max(now, 0.0);
    }
    maps_1._data[at] = float4(1.0 - exp(-amount), amount, now, 0.0);
}

kernel void foam(constant Sea& sea [[buffer(0)]], device maps& maps_1 [[buffer(5)]], uint3 gl_GlobalInvocationID [[thread_position_in_grid]])
{
    threadgroup float4 held[1024];
    uint3 id = gl_GlobalInvocationID;
    uint3 param = id;
    _foam(param, sea, maps_1);
}

