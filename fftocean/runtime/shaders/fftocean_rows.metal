// Not run: no Metal compiler was at hand. The same SPIR-V as that of the GLSL kernels, which are run.
// Kernel `rows` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.
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

struct h0
{
    float4 _data[1];
};

struct work
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
float2 phasor(thread const float& turn)
{
    float quarter = floor((4.0 * turn) + 0.5);
    float x = turn - (0.25 * quarter);
    float q = x * x;
    float s = x * (6.283185482025146484375 + (q * ((-41.341663360595703125) + (q * (81.59197998046875 + (q * (-75.36965179443359375)))))));
    float c = 1.0 + (q * ((-19.739208221435546875) + (q * (64.939361572265625 + (q * ((-85.44745635986328125) + (q * 59.362560272216796875)))))));
    uint quadrant = uint(quarter);
    float2 turned = select(float2(-s, c), float2(c, s), bool2((quadrant & 1u) == 0u));
    return select(-turned, turned, bool2((quadrant & 2u) == 0u));
}

static inline __attribute__((always_inline))
float2 times(thread const float2& a, thread const float2& b)
{
    return float2((a.x * b.x) - (a.y * b.y), (a.x * b.y) + (a.y * b.x));
}

static inline __attribute__((always_inline))
float whole(thread const uint& i, thread const uint& n)
{
    return ((2u * i) < n) ? float(i) : (float(i) - float(n));
}

static inline __attribute__((always_inline))
float2 times_i(thread const float2& a)
{
    return float2(-a.y, a.x);
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
void _rows(thread const uint3& group, thread const uint& t, const device twiddle& twiddle_1, constant Sea& sea, threadgroup float4 (&held)[1024], const device h0& h0_1, const device twiddle& wave, device work& work_1)
{
    uint nx = sea.table[group.y].nx;
    uint ny = sea.table[group.y].ny;
    uint start = 512u * group.x;
    if (start >= (nx * ny))
    {
        return;
    }
    uint first = sea.table[group.y].first;
    float4 lifts = sea.table[group.y].lifts;
    uint lines = 512u / nx;
    for (uint i = t; i < 512u; i += 256u)
    {
        uint texel = start + i;
        if (texel >= (nx * ny))
        {
            continue;
        }
        uint x = texel & (nx - 1u);
        float4 amplitude = h0_1._data[first + texel];
        float2 cycles_and_factor = wave._data[first + texel];
        uint turn = (uint(cycles_and_factor.x) * sea.tick) & sea.mask;
        float param = float(turn) * sea.turns_per_tick;
        float2 e = phasor(param);
        float2 param_1 = amplitude.xy;
        float2 param_2 = float2(e.x, -e.y);
        float2 param_3 = amplitude.zw;
        float2 param_4 = e;
        float2 height = times(param_1, param_2) + times(param_3, param_4);
        float2 potential = height * cycles_and_factor.y;
        uint param_5 = x;
        uint param_6 = nx;
        uint param_7 = texel / nx;
        uint param_8 = ny;
        float2 k = float2(whole(param_5, param_6), whole(param_7, param_8)) * sea.table[group.y].dk;
        float2 param_9 = potential * k.x;
        float2 displace_x = times_i(param_9);
        float2 param_10 = potential * k.y;
        float2 displace_y = times_i(param_10);
        float2 param_11 = height * k.x;
        float2 slope_x = times_i(param_11);
        float2 param_12 = height * k.y;
        float2 slope_y = times_i(param_12);
        float2 stretch_xx = potential * ((-k.x) * k.x);
        float2 stretch_xy = potential * ((-k.x) * k.y);
        float2 stretch_yy = potential * ((-k.y) * k.y);
        uint place = (x * lines) + (i / nx);
        float2 param_13 = displace_y;
        float2 param_14 = stretch_xy;
        held[place] = float4(displace_x + (times_i(param_13) * lifts.x), height + (times_i(param_14) * lifts.y));
        float2 param_15 = slope_y;
        float2 param_16 = stretch_yy;
        held[512u + place] = float4(slope_x + (times_i(param_15) * lifts.z), stretch_xx + (times_i(param_16) * lifts.w));
    }
    threadgroup_barrier(mem_flags::mem_threadgroup);
    uint param_17 = t;
    uint param_18 = nx;
    transform(param_17, param_18, twiddle_1, sea, held);
    for (uint j = t; j < 512u; j += 256u)
    {
        uint made = start + j;
        if (made >= (nx * ny))
        {
            continue;
        }
        uint from = ((made & (nx - 1u)) * lines) + (j / nx);
        work_1._data[2u * (first + made)] = held[from];
        work_1._data[(2u * (first + made)) + 1u] = held[512u + from];
    }
}

kernel void rows(constant Sea& sea [[buffer(0)]], const device h0& h0_1 [[buffer(1)]], const device twiddle& wave [[buffer(2)]], const device twiddle& twiddle_1 [[buffer(3)]], device work& work_1 [[buffer(4)]], uint3 gl_WorkGroupID [[threadgroup_position_in_grid]], uint gl_LocalInvocationIndex [[thread_index_in_threadgroup]])
{
    threadgroup float4 held[1024];
    uint3 group = gl_WorkGroupID;
    uint t = gl_LocalInvocationIndex;
    uint3 param = group;
    uint param_1 = t;
    _rows(param, param_1, twiddle_1, sea, held, h0_1, wave, work_1);
}

