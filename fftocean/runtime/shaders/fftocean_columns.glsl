// Compiled by glslangValidator and run on Vulkan (lavapipe), where fields equal those of the other languages.
// Kernel `columns` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.
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

layout(set = 0, binding = 3, std430) readonly buffer twiddle
{
    vec2 _data[];
} twiddle_1;

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

layout(set = 0, binding = 4, std430) buffer work
{
    vec4 _data[];
} work_1;

layout(set = 0, binding = 5, std430) buffer maps
{
    vec4 _data[];
} maps_1;

shared vec4 held[1024];

vec2 times(vec2 a, vec2 b)
{
    return vec2((a.x * b.x) - (a.y * b.y), (a.x * b.y) + (a.y * b.x));
}

vec4 times_both(vec2 w, vec4 v)
{
    vec2 param = w;
    vec2 param_1 = v.xy;
    vec2 param_2 = w;
    vec2 param_3 = v.zw;
    return vec4(times(param, param_1), times(param_2, param_3));
}

void transform(uint t, uint n)
{
    uint lines = 512u / n;
    uint l = t & (lines - 1u);
    uint butterfly = t / lines;
    for (uint part = 1u; part < n; part = 2u * part)
    {
        uint r = butterfly & (part - 1u);
        vec2 w = twiddle_1._data[r * (sea.twiddles / (2u * part))];
        vec4 a = held[t];
        vec4 b = held[512u + t];
        vec2 param = w;
        vec4 param_1 = held[256u + t];
        vec4 c = times_both(param, param_1);
        vec2 param_2 = w;
        vec4 param_3 = held[768u + t];
        vec4 d = times_both(param_2, param_3);
        barrier();
        uint to = (((2u * butterfly) - r) * lines) + l;
        held[to] = a + c;
        held[512u + to] = b + d;
        held[to + (part * lines)] = a - c;
        held[(512u + to) + (part * lines)] = b - d;
        barrier();
    }
}

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

void _columns(uvec3 group, uint t)
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
    barrier();
    uint param = t;
    uint param_1 = ny;
    transform(param, param_1);
    vec4 lowered = uintBitsToFloat(uvec4(2130706432u) - floatBitsToUint(sea.table[group.y].lifts));
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
        vec4 a = held[j];
        vec4 b = held[512u + j];
        uint at_1 = (sea.table[group.y].first_map + ((j / lines) * nx)) + x_1;
        vec2 slope = vec2(b.x, b.y * lowered.z);
        maps_1._data[at_1] = vec4(c * a.x, (c * a.y) * lowered.x, a.z, (c * a.w) * lowered.y);
        maps_1._data[at_1 + plane] = vec4(slope, c * b.z, (c * b.w) * lowered.w);
        maps_1._data[at_1 + (2u * plane)] = vec4(slope * slope, slope.x * slope.y, 0.0);
    }
}

void main()
{
    uvec3 group = gl_WorkGroupID;
    uint t = gl_LocalInvocationIndex;
    uvec3 param = group;
    uint param_1 = t;
    _columns(param, param_1);
}

