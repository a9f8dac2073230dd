// Not run: no Metal compiler was at hand. The same SPIR-V as that of the GLSL kernels, which are run.
// Kernel `heights` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.
// Source: fftocean.hlsl, SHA-256 87ca8ec0a5af0c2655da9827ebd1da26d3e673de82df8cb445d9f38fb417e22e
// Tools: Glslang Version: 11:12.0.0; spirv-cross 2021.01.15+1.3.239.0-1
#pragma clang diagnostic ignored "-Wmissing-prototypes"

#include <metal_stdlib>
#include <simd/simd.h>

using namespace metal;

struct Water
{
    float2 moved;
    float height;
    float2 slope;
    float3 stretch;
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

struct maps
{
    float4 _data[1];
};

struct places
{
    float2 _data[1];
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
Water water_at(thread const float2& rest, constant Sea& sea, device maps& maps_1)
{
    Water water;
    water.moved = float2(0.0);
    water.height = 0.0;
    water.slope = float2(0.0);
    water.stretch = float3(0.0);
    for (uint i = 0u; i < sea.tiles; i++)
    {
        uint2 n = uint2(sea.table[i].nx, sea.table[i].ny);
        float2 place = fract((rest / sea.table[i].size) + sea.table[i].origin) * float2(n);
        float2 spacing = sea.table[i].size / float2(n);
        uint param = n.x;
        uint param_1 = n.y;
        uint plane = texels_of_levels(param, param_1);
        for (uint j = 0u; j < 4u; j++)
        {
            uint2 side = uint2(j & 1u, j >> 1u);
            float2 p = abs((place - floor(place)) - float2(side));
            float2 rest_of = float2(1.0) - p;
            float bilinear = rest_of.x * rest_of.y;
            float value = bilinear * (((1.0 + p.x) + p.y) - (2.0 * dot(p, p)));
            float2 gradient = (((p * bilinear) * rest_of) * spacing) * (float2(1.0) - (float2(side) * 2.0));
            uint2 texel = (uint2(floor(place)) + side) & (n - uint2(1u));
            uint at = (sea.table[i].first_map + (texel.y * n.x)) + texel.x;
            float4 a = maps_1._data[at];
            float4 b = maps_1._data[at + plane];
            water.moved += ((a.xy * value) + float2(dot(gradient, float2(b.z, a.w)), dot(gradient, float2(a.w, b.w))));
            water.height += ((value * a.z) + dot(gradient, b.xy));
            water.slope += (b.xy * bilinear);
            water.stretch += (float3(b.zw, a.w) * bilinear);
        }
    }
    return water;
}

static inline __attribute__((always_inline))
float jacobian_of(thread const Water& water)
{
    return ((1.0 + water.stretch.x) * (1.0 + water.stretch.y)) - (water.stretch.z * water.stretch.z);
}

static inline __attribute__((always_inline))
void _heights(thread const uint3& id, constant Sea& sea, device maps& maps_1, const device places& places_1, device maps& answers)
{
    if (id.x >= sea.points)
    {
        return;
    }
    float2 goal = places_1._data[id.x];
    float2 rest = goal;
    float2 param = rest;
    Water water = water_at(param, sea, maps_1);
    for (uint i = 0u; i < sea.iterations; i++)
    {
        float2 apart = (rest + water.moved) - goal;
        Water param_1 = water;
        float determinant = fast::max(jacobian_of(param_1), 0.20000000298023223876953125);
        float3 s = water.stretch;
        rest -= (float2(((1.0 + s.y) * apart.x) - (s.z * apart.y), ((1.0 + s.x) * apart.y) - (s.z * apart.x)) / float2(determinant));
        float2 param_2 = rest;
        water = water_at(param_2, sea, maps_1);
    }
    float3 s_1 = water.stretch;
    Water param_3 = water;
    float3 normal = float3((s_1.z * water.slope.y) - ((1.0 + s_1.y) * water.slope.x), (s_1.z * water.slope.x) - ((1.0 + s_1.x) * water.slope.y), jacobian_of(param_3));
    answers._data[2u * id.x] = float4(rest, water.height, length((rest + water.moved) - goal));
    Water param_4 = water;
    answers._data[(2u * id.x) + 1u] = float4(normal / float3(fast::max(length(normal), 9.9999996826552253889678874634872e-21)), jacobian_of(param_4));
}

kernel void heights(constant Sea& sea [[buffer(0)]], device maps& maps_1 [[buffer(5)]], device maps& answers [[buffer(7)]], const device places& places_1 [[buffer(8)]], uint3 gl_GlobalInvocationID [[thread_position_in_grid]])
{
    threadgroup float4 held[1024];
    uint3 id = gl_GlobalInvocationID;
    uint3 param = id;
    _heights(param, sea, maps_1, places_1, answers);
}

