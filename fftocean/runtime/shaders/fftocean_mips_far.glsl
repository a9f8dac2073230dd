// Compiled by glslangValidator and run on Vulkan (lavapipe), where fields equal those of the other languages.
// Kernel `mips_far` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.
// Source: fftocean.hlsl, SHA-256 87ca8ec0a5af0c2655da9827ebd1da26d3e673de82df8cb445d9f38fb417e22e
// Tools: Glslang Version: 11:12.0.0; spirv-cross 2021.01.15+1.3.239.0-1
#version 450
layout(local_size_x = 256, local_size_y = 1, local_size_z = 1) in;

struct Tile
{
    uint nx;
    uint ny;
    uint first;
    uint first_map;
    vec2 size;
    vec2 dk;
    vec4 lifts;
    vec2 origin;
    vec2 unused;
};

layout(set = 0, binding = 0, std140) uniform Sea
{
    uint tick;
    uint mask;
    uint tiles;
    uint twiddles;
    float turns_per_tick;
    float choppiness;
    uint points;
    uint iterations;
    ivec2 corner;
    ivec2 corner_before;
    vec2 corner_place;
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
} sea;

layout(set = 0, binding = 5, std430) buffer maps
{
    vec4 _data[];
} maps_1;

shared vec4 held[1024];

uint texels_of_levels(uint nx, uint ny)
{
    uint sum = 1u;
    uvec2 size = uvec2(nx, ny);
    for (; (size.x * size.y) > 1u; size = max((size / uvec2(2u)), uvec2(1u)))
    {
        sum += (size.x * size.y);
    }
    return sum;
}

uvec3 plane_at(uint index)
{
    if (index >= (3u * sea.tiles))
    {
        return uvec3(sea.foam_side, sea.foam_side, sea.foam_first);
    }
    uint tile = index / 3u;
    uint nx = sea.table[tile].nx;
    uint ny = sea.table[tile].ny;
    uint param = nx;
    uint param_1 = ny;
    return uvec3(nx, ny, sea.table[tile].first_map + ((index % 3u) * texels_of_levels(param, param_1)));
}

uvec3 next_level(uvec3 plane)
{
    return uvec3(max((plane.xy / uvec2(2u)), uvec2(1u)), plane.z + (plane.x * plane.y));
}

void average(uvec3 group, uint t, uint base)
{
    uint param = group.z;
    uvec3 below = plane_at(param);
    for (uint i = 0u; i < base; i++)
    {
        if ((below.x * below.y) == 1u)
        {
            return;
        }
        uvec3 param_1 = below;
        below = next_level(param_1);
    }
    if (any(greaterThanEqual((uvec2(32u) * group.xy), below.xy)))
    {
        return;
    }
    for (uint side = 16u; side > 0u; side /= 2u)
    {
        if ((below.x * below.y) <= 1u)
        {
            return;
        }
        uvec3 param_2 = below;
        uvec3 level = next_level(param_2);
        uvec2 own = uvec2(t % side, t / side);
        bool busy = (own.y < side) && all(lessThan(((uvec2(side) * group.xy) + own), level.xy));
        uvec2 low = uvec2(2u) * own;
        uvec2 high = min((low + uvec2(1u)), (min(uvec2(2u * side, 2u * side), below.xy) - uvec2(1u)));
        vec4 sum = vec4(0.0);
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
        barrier();
        if (busy)
        {
            held[(16u * own.y) + own.x] = sum * 0.25;
            maps_1._data[((level.z + (((side * group.y) + own.y) * level.x)) + (side * group.x)) + own.x] = sum * 0.25;
        }
        barrier();
        below = level;
    }
}

void _mips_far(uvec3 group, uint t)
{
    uvec3 param = group;
    uint param_1 = t;
    uint param_2 = 5u;
    average(param, param_1, param_2);
}

void main()
{
    uvec3 group = gl_WorkGroupID;
    uint t = gl_LocalInvocationIndex;
    uvec3 param = group;
    uint param_1 = t;
    _mips_far(param, param_1);
}

