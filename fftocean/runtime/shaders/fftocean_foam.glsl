// Compiled by glslangValidator and run on Vulkan (lavapipe), where fields equal those of the other languages.
// Kernel `foam` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.
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

void _foam(uvec3 id)
{
    uint side = sea.foam_side;
    if (any(greaterThanEqual(id.xy, uvec2(side, side))))
    {
        return;
    }
    ivec2 own = (ivec2(id.xy) - sea.corner) & ivec2(int(side - 1u), int(side - 1u));
    vec2 rest = sea.corner_place + (vec2(own) * sea.cell);
    vec3 stretch = vec3(0.0);
    for (uint i = 0u; i < sea.tiles; i++)
    {
        uvec2 n = uvec2(sea.table[i].nx, sea.table[i].ny);
        uvec2 nearest = uvec2(floor((fract((rest / sea.table[i].size) + sea.table[i].origin) * vec2(n)) + vec2(0.5))) & (n - uvec2(1u));
        uint texel = (sea.table[i].first_map + (nearest.y * n.x)) + nearest.x;
        uint param = n.x;
        uint param_1 = n.y;
        stretch += vec3(maps_1._data[texel + texels_of_levels(param, param_1)].zw, maps_1._data[texel].w);
    }
    float middle = 1.0 + (0.5 * (stretch.x + stretch.y));
    float half_difference = 0.5 * (stretch.x - stretch.y);
    float now = sea.threshold - (middle - sqrt((half_difference * half_difference) + (stretch.z * stretch.z)));
    uint at = (sea.foam_first + (id.y * side)) + id.x;
    float before = maps_1._data[at].z;
    float d = exp(((-0.25) * sea.seconds) / sea.decay);
    float made = ((((((((0.5 * d) * d) * d) * d) * max(before, 0.0)) + (((d * d) * d) * max(mix(before, now, 0.25), 0.0))) + ((d * d) * max(mix(before, now, 0.5), 0.0))) + (d * max(mix(before, now, 0.75), 0.0))) + (0.5 * max(now, 0.0));
    float amount = ((((d * d) * d) * d) * maps_1._data[at].y) + (((0.25 * sea.seconds) * sea.strength) * made);
    ivec2 old = (sea.corner + own) - sea.corner_before;
    if (any(lessThan(old, ivec2(0))) || any(greaterThanEqual(old, ivec2(int(side), int(side)))))
    {
        amount = (sea.decay * sea.strength) * max(now, 0.0);
    }
    maps_1._data[at] = vec4(1.0 - exp(-amount), amount, now, 0.0);
}

void main()
{
    uvec3 id = gl_GlobalInvocationID;
    uvec3 param = id;
    _foam(param);
}

