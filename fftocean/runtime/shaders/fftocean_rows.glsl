// Compiled by glslangValidator and run on Vulkan (lavapipe), where fields equal those of the other languages.
// Kernel `rows` of fftocean, by tools/shaders.py: edit fftocean.hlsl instead.
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

layout(set = 0, binding = 1, std430) readonly buffer h0
{
    vec4 _data[];
} h0_1;

layout(set = 0, binding = 2, std430) readonly buffer wave
{
    vec2 _data[];
} wave_1;

layout(set = 0, binding = 4, std430) buffer work
{
    vec4 _data[];
} work_1;

shared vec4 held[1024];

vec2 phasor(float turn)
{
    float quarter = floor((4.0 * turn) + 0.5);
    float x = turn - (0.25 * quarter);
    float q = x * x;
    float s = x * (6.283185482025146484375 + (q * ((-41.341663360595703125) + (q * (81.59197998046875 + (q * (-75.36965179443359375)))))));
    float c = 1.0 + (q * ((-19.739208221435546875) + (q * (64.939361572265625 + (q * ((-85.44745635986328125) + (q * 59.362560272216796875)))))));
    uint quadrant = uint(quarter);
    vec2 turned = mix(vec2(-s, c), vec2(c, s), bvec2((quadrant & 1u) == 0u));
    return mix(-turned, turned, bvec2((quadrant & 2u) == 0u));
}

vec2 times(vec2 a, vec2 b)
{
    return vec2((a.x * b.x) - (a.y * b.y), (a.x * b.y) + (a.y * b.x));
}

float whole(uint i, uint n)
{
    return ((2u * i) < n) ? float(i) : (float(i) - float(n));
}

vec2 times_i(vec2 a)
{
    return vec2(-a.y, a.x);
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

void _rows(uvec3 group, uint t)
{
    uint nx = sea.table[group.y].nx;
    uint ny = sea.table[group.y].ny;
    uint start = 512u * group.x;
    if (start >= (nx * ny))
    {
        return;
    }
    uint first = sea.table[group.y].first;
    vec4 lifts = sea.table[group.y].lifts;
    uint lines = 512u / nx;
    for (uint i = t; i < 512u; i += 256u)
    {
        uint texel = start + i;
        if (texel >= (nx * ny))
        {
            continue;
        }
        uint x = texel & (nx - 1u);
        vec4 amplitude = h0_1._data[first + texel];
        vec2 cycles_and_factor = wave_1._data[first + texel];
        uint turn = (uint(cycles_and_factor.x) * sea.tick) & sea.mask;
        float param = float(turn) * sea.turns_per_tick;
        vec2 e = phasor(param);
        vec2 param_1 = amplitude.xy;
        vec2 param_2 = vec2(e.x, -e.y);
        vec2 param_3 = amplitude.zw;
        vec2 param_4 = e;
        vec2 height = times(param_1, param_2) + times(param_3, param_4);
        vec2 potential = height * cycles_and_factor.y;
        uint param_5 = x;
        uint param_6 = nx;
        uint param_7 = texel / nx;
        uint param_8 = ny;
        vec2 k = vec2(whole(param_5, param_6), whole(param_7, param_8)) * sea.table[group.y].dk;
        vec2 param_9 = potential * k.x;
        vec2 displace_x = times_i(param_9);
        vec2 param_10 = potential * k.y;
        vec2 displace_y = times_i(param_10);
        vec2 param_11 = height * k.x;
        vec2 slope_x = times_i(param_11);
        vec2 param_12 = height * k.y;
        vec2 slope_y = times_i(param_12);
        vec2 stretch_xx = potential * ((-k.x) * k.x);
        vec2 stretch_xy = potential * ((-k.x) * k.y);
        vec2 stretch_yy = potential * ((-k.y) * k.y);
        uint place = (x * lines) + (i / nx);
        vec2 param_13 = displace_y;
        vec2 param_14 = stretch_xy;
        held[place] = vec4(displace_x + (times_i(param_13) * lifts.x), height + (times_i(param_14) * lifts.y));
        vec2 param_15 = slope_y;
        vec2 param_16 = stretch_yy;
        held[512u + place] = vec4(slope_x + (times_i(param_15) * lifts.z), stretch_xx + (times_i(param_16) * lifts.w));
    }
    barrier();
    uint param_17 = t;
    uint param_18 = nx;
    transform(param_17, param_18);
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

void main()
{
    uvec3 group = gl_WorkGroupID;
    uint t = gl_LocalInvocationIndex;
    uvec3 param = group;
    uint param_1 = t;
    _rows(param, param_1);
}

