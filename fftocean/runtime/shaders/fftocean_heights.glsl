// Compiled by glslangValidator and run on Vulkan (lavapipe), where fields equal those of the other languages.
// Kernel `heights` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.
// Source: fftocean.hlsl, SHA-256 87ca8ec0a5af0c2655da9827ebd1da26d3e673de82df8cb445d9f38fb417e22e
// Tools: Glslang Version: 11:12.0.0; spirv-cross 2021.01.15+1.3.239.0-1
#version 450
layout(local_size_x = 64, local_size_y = 1, local_size_z = 1) in;

struct Water
{
    vec2 moved;
    float height;
    vec2 slope;
    vec3 stretch;
};

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

layout(set = 0, binding = 8, std430) readonly buffer places
{
    vec2 _data[];
} places_1;

layout(set = 0, binding = 7, std430) buffer answers
{
    vec4 _data[];
} answers_1;

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

Water water_at(vec2 rest)
{
    Water water;
    water.moved = vec2(0.0);
    water.height = 0.0;
    water.slope = vec2(0.0);
    water.stretch = vec3(0.0);
    for (uint i = 0u; i < sea.tiles; i++)
    {
        uvec2 n = uvec2(sea.table[i].nx, sea.table[i].ny);
        vec2 place = fract((rest / sea.table[i].size) + sea.table[i].origin) * vec2(n);
        vec2 spacing = sea.table[i].size / vec2(n);
        uint param = n.x;
        uint param_1 = n.y;
        uint plane = texels_of_levels(param, param_1);
        for (uint j = 0u; j < 4u; j++)
        {
            uvec2 side = uvec2(j & 1u, j >> 1u);
            vec2 p = abs((place - floor(place)) - vec2(side));
            vec2 rest_of = vec2(1.0) - p;
            float bilinear = rest_of.x * rest_of.y;
            float value = bilinear * (((1.0 + p.x) + p.y) - (2.0 * dot(p, p)));
            vec2 gradient = (((p * bilinear) * rest_of) * spacing) * (vec2(1.0) - (vec2(side) * 2.0));
            uvec2 texel = (uvec2(floor(place)) + side) & (n - uvec2(1u));
            uint at = (sea.table[i].first_map + (texel.y * n.x)) + texel.x;
            vec4 a = maps_1._data[at];
            vec4 b = maps_1._data[at + plane];
            water.moved += ((a.xy * value) + vec2(dot(gradient, vec2(b.z, a.w)), dot(gradient, vec2(a.w, b.w))));
            water.height += ((value * a.z) + dot(gradient, b.xy));
            water.slope += (b.xy * bilinear);
            water.stretch += (vec3(b.zw, a.w) * bilinear);
        }
    }
    return water;
}

float jacobian_of(Water water)
{
    return ((1.0 + water.stretch.x) * (1.0 + water.stretch.y)) - (water.stretch.z * water.stretch.z);
}

void _heights(uvec3 id)
{
    if (id.x >= sea.points)
    {
        return;
    }
    vec2 goal = places_1._data[id.x];
    vec2 rest = goal;
    vec2 param = rest;
    Water water = water_at(param);
    for (uint i = 0u; i < sea.iterations; i++)
    {
        vec2 apart = (rest + water.moved) - goal;
        Water param_1 = water;
        float determinant = max(jacobian_of(param_1), 0.20000000298023223876953125);
        vec3 s = water.stretch;
        rest -= (vec2(((1.0 + s.y) * apart.x) - (s.z * apart.y), ((1.0 + s.x) * apart.y) - (s.z * apart.x)) / vec2(determinant));
        vec2 param_2 = rest;
        water = water_at(param_2);
    }
    vec3 s_1 = water.stretch;
    Water param_3 = water;
    vec3 normal = vec3((s_1.z * water.slope.y) - ((1.0 + s_1.y) * water.slope.x), (s_1.z * water.slope.x) - ((1.0 + s_1.x) * water.slope.y), jacobian_of(param_3));
    answers_1._data[2u * id.x] = vec4(rest, water.height, length((rest + water.moved) - goal));
    Water param_4 = water;
    answers_1._data[(2u * id.x) + 1u] = vec4(normal / vec3(max(length(normal), 9.9999996826552253889678874634872e-21)), jacobian_of(param_4));
}

void main()
{
    uvec3 id = gl_GlobalInvocationID;
    uvec3 param = id;
    _heights(param);
}

