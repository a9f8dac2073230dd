// Not run: no Metal compiler was at hand. The same SPIR-V as that of the GLSL kernels, which are run.
// Kernel `columns` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.
// Source: fftocean.hlsl, SHA-256 87ca8ec0a5af0c2655da9827ebd1da26d3e673de82df8cb445d9f38fb417e22e
// Tools: Glslang Version: 11:12.0.0; spirv-cross 2021.01.15+1.3.239.0-1
#pragma clang diagnostic ignored "-Wmissing-prototypes"

#include <metal_stdlib>
#include <simd/simd.h>

using namespace metal;

struct twiddle
{
    float2 _data[1];
};

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

struct work
{
    float4 _data[1];
};

struct h0
{
    float4 _data[1];
};

struct Target
{
    uint target_plane;
    uint target_level;
    uint unused_3;
    uint unused_4;
};

static inline __attribute__((always_inline))
float2 times(thread const float2& a, thread const float2& b)
{
    return float2((a.x * b.x) - (a.y * b.y), (a.x * b.y) + (a.y * b.x));
}

static inline __attribute__((always_inline))
float4 times_both(thread const float2& w, thread const float4& v)
{
    float2 param = w;
    float2 param_1 = v.xy;
    float2 param_2 = w;
    float2 param_3 = v.zw;
    return float4(times(param, param_1), times(param_2, param_3));
}

static inline __attribute__((always_inline))
void transform(thread const uint& t, thread const uint& n, const device twiddle& twiddle_1, constant Sea& sea, threadgroup float4 (&held)[1024])
{
    uint lines = 512u / n;
    uint l = t & (lines - 1u);
    uint butterfly = t / lines;
    for (uint part = 1u; part < n; part = 2u * part)
    {
        uint r = butterfly & (part - 1u);
        float2 w = twiddle_1._data[r * (sea.twiddles / (2u * part))];
        float4 a = held[t];
        float4 b = held[512u + t];
        float2 param = w;
        float4 param_1 = held[256u + t];
        float4 c = times_both(param, param_1);
        float2 param_2 = w;
        float4 param_3 = held[768u + t];
        float4 d = times_both(param_2, param_3);
        threadgroup_barrier(mem_flags::mem_threadgroup);
        uint to = (((2u * butterfly) - r) * lines) + l;
        held[to] = a + c;
        held[512u + to] = b + d;
        held[to + (part * lines)] = a - c;
        held[(512u + to) + (part * lines)] = b - d;
        threadgroup_barrier(mem_flags::mem_threadgroup);
    }
}

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
void _columns(thread const uint3& group, thread const uint& t, const device twiddle& twiddle_1, constant Sea& sea, threadgroup float4 (&held)[1024], device work& work_1, device work& maps)
{
    uint nx = sea.table[group.y].nx;
    uint ny = sea.table[group.y].ny;
    if ((512u * group.x) >= (nx * ny))
    {
        return;
    }
    uint first = sea.table[group.y].first;
    uint lines = 512u / ny;
    for (uint i = t; i < 512u; i += 256u)
    {
        uint x = (group.x * lines) + (i & (lines - 1u));
        if (x >= nx)
        {
            continue;
        }
        uint at = 2u * ((first + ((i / lines) * nx)) + x);
        held[i] = work_1._data[at];
        held[512u + i] = work_1._data[at + 1u];
    }
    threadgroup_barrier(mem_flags::mem_threadgroup);
    uint param = t;
    uint param_1 = ny;
    transform(param, param_1, twiddle_1, sea, held);
    float4 lowered = as_type<float4>(uint4(2130706432u) - as_type<uint4>(sea.table[group.y].lifts));
    float c = sea.choppiness;
    uint param_2 = nx;
    uint param_3 = ny;
    uint plane = texels_of_levels(param_2, param_3);
    for (uint j = t; j < 512u; j += 256u)
    {
        uint x_1 = (group.x * lines) + (j & (lines - 1u));
        if (x_1 >= nx)
        {
            continue;
        }
        float4 a = held[j];
        float4 b = held[512u + j];
        uint at_1 = (sea.table[group.y].first_map + ((j / lines) * nx)) + x_1;
        float2 slope = float2(b.x, b.y * lowered.z);
        maps._data[at_1] = float4(c * a.x, (c * a.y) * lowered.x, a.z, (c * a.w) * lowered.y);
        maps._data[at_1 + plane] = float4(slope, c * b.z, (c * b.w) * lowered.w);
        maps._data[at_1 + (2u * plane)] = float4(slope * slope, slope.x * slope.y, 0.0);
    }
}

kernel void columns(constant Sea& sea [[buffer(0)]], const device twiddle& twiddle_1 [[buffer(3)]], device work& work_1 [[buffer(4)]], device work& maps [[buffer(5)]], uint3 gl_WorkGroupID [[threadgroup_position_in_grid]], uint gl_LocalInvocationIndex [[thread_index_in_threadgroup]])
{
    threadgroup float4 held[1024];
    uint3 group = gl_WorkGroupID;
    uint t = gl_LocalInvocationIndex;
    uint3 param = group;
    uint param_1 = t;
    _columns(param, param_1, twiddle_1, sea, held, work_1, maps);
}

