// Compiled by glslangValidator and run on Vulkan (lavapipe), where fields equal those of the other languages.
// Kernel `textures` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.
// Source: fftocean.hlsl, SHA-256 87ca8ec0a5af0c2655da9827ebd1da26d3e673de82df8cb445d9f38fb417e22e
// Tools: Glslang Version: 11:12.0.0; spirv-cross 2021.01.15+1.3.239.0-1
#version 450
layout(local_size_x = 8, local_size_y = 8, local_size_z = 1) in;

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

layout(set = 0, binding = 9, std140) uniform Target
{
    uint target_plane;
    uint target_level;
    uint unused_3;
    uint unused_4;
} target_level;

layout(set = 0, binding = 5, std430) buffer maps
{
    vec4 _data[];
} maps_1;

layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D image;

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

void _textures(uvec3 id)
{
    uint param = target_level.target_plane;
    uvec3 level = plane_at(param);
    for (uint i = 0u; i < target_level.target_level; i++)
    {
        uvec3 param_1 = level;
        level = next_level(param_1);
    }
    if (any(greaterThanEqual(id.xy, level.xy)))
    {
        return;
    }
    vec4 storeTemp = maps_1._data[(level.z + (id.y * level.x)) + id.x];
    imageStore(image, ivec2(id.xy), storeTemp);
}

void main()
{
    uvec3 id = gl_GlobalInvocationID;
    uvec3 param = id;
    _textures(param);
}

