// Not run: no Metal compiler was at hand. The same SPIR-V as that of the GLSL kernels, which are run.
// Kernel `mips` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.
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
void average(thread const uint3& group, thread const uint& t, thread const uint& base, constant Sea& sea, device maps& maps_1, threadgroup float4 (&held)[1024])
{
    uint param = group.z;
    uint3 below = plane_at(param, sea);
    for (uint i = 0u; i < base; i++)
    {
        if ((below.x * below.y) == 1u)
        {
            return;
        }
        uint3 param_1 = below;
        below = next_level(param_1);
    }
    if (any((uint2(32u) * group.xy) >= below.xy))
    {
        return;
    }
    for (uint side = 16u; side > 0u; side /= 2u)
    {
        if ((below.x * below.y) <= 1u)
        {
            return;
        }
        uint3 param_2 = below;
        uint3 level0 = next_level(param_2);
        uint2 own = uint2(t % side, t / side);
        bool busy = (own.y < side) && all(((uint2(side) * group.xy) + own) < level0.xy);
        uint2 low = uint2(2u) * own;
        uint2 high = min((low + uint2(1u)), (min(uint2(2u * side, 2u * side), below.xy) - uint2(1u)));
        float4 sum = float4(0.0);
        if (busy)
        {
            if (side == 16u)
            {
                uint at = below.z + (32u * ((group.y * below.x) + group.x));
                sum = (maps_1._data[(at + (low.y * below.x)) + low.x] + maps_1._data[(at + (low.y * below.x)) + high.x]) + (maps_1._data[(at + (high.y * below.x)) + low.x] + maps_1._data[(at + (high.y * below.x)) + high.x]);
            }
            else
            {
                sum = (held[(16u * low.y) + low.x] + held[(16u * low.y) + high.x]) + (held[(16u * high.y) + low.x] + held[(16u * high.y) + high.x]);
            }
        }
        threadgroup_barrier(mem_flags::mem_threadgroup);
        if (busy)
        {
            held[(16u * own.y) + own.x] = sum * 0.25;
            maps_1._data[((level0.z + (((side * group.y) + own.y) * level0.x)) + (side * group.x)) + own.x] = sum * 0.25;
        }
        threadgroup_barrier(mem_flags::mem_threadgroup);
        below = level0;
    }
}

static inline __attribute__((always_inline))
void _mips(thread const uint3& group, thread const uint& t, constant Sea& sea, device maps& maps_1, threadgroup float4 (&held)[1024])
{
    uint3 param = group;
    uint param_1 = t;
    uint param_2 = 0u;
    average(param, param_1, param_2, sea, maps_1, held);
}

kernel void mips(constant Sea& sea [[buffer(0)]], device maps& maps_1 [[buffer(5)]], uint3 gl_WorkGroupID [[threadgroup_position_in_grid]], uint gl_LocalInvocationIndex [[thread_index_in_threadgroup]])
{
    threadgroup float4 held[1024];
    uint3 group = gl_WorkGroupID;
    uint t = gl_LocalInvocationIndex;
    uint3 param = group;
    uint param_1 = t;
    _mips(param, param_1, sea, maps_1, held);
}

