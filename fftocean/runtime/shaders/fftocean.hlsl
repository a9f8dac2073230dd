// fftocean: the kernels of a sea at run time. docs/kernels.md has bindings, dispatch sizes and buffers.
//
// All tiles of a sea live in the same buffers, and one dispatch does all of them: `rows` and `columns` make a frame, `mips` and
// `mips_far` average it, `foam` moves on the foam of the sum of all tiles, `heights` finds the surface at points of the world, and
// `textures` copies maps to textures. fftocean.wgsl has the same lines in the same order.
//
// Nothing calls the built-in sin and cos, which are only good to 2^-11.

#define MOST_TILES 16
#define PLACES 512u // samples that a group transforms at once: 512 / n lines of n
#define THREADS 256u // half of them: a thread does one butterfly

struct Tile
{
    uint nx, ny; // powers of two, 2 to 512
    uint first; // first texel in h0, wave and work
    uint first_map; // first texel in maps
    float2 size; // [m]
    float2 dk; // 2 pi / size [rad/m]
    float4 lifts; // powers of two for displace_y, stretch_xy, slope_y, stretch_yy; (1, mixed, 1, 1) will do
    float2 origin; // place of the origin of foam and points, in sides of the tile, 0 to 1
    float2 unused;
};

#ifndef FFTOCEAN_OWN_BINDINGS // an engine that declares them in its own way
cbuffer Sea : register(b0)
{
    uint tick, mask; // moment of the loop; ticks - 1
    uint tiles, twiddles; // counts
    float turns_per_tick, choppiness; // 1 / ticks
    uint points, iterations; // of `heights`
    int2 corner, corner_before; // first cell of the window of foam, now and at the last step
    float2 corner_place; // of the middle of that cell, from the origin [m]
    float cell, seconds; // side of a cell [m]; length of the step [s]
    float decay, threshold, strength; // of foam [s], [-], [1/s]
    uint foam_side, foam_first; // cells a side, a power of two or 0; first texel in maps
    uint unused_0, unused_1, unused_2;
    Tile table[MOST_TILES];
};

StructuredBuffer<float4> h0 : register(t1); // h0(k), conj(h0(-k)): tile<i>_h0.bin
StructuredBuffer<float2> wave : register(t2); // cycles in a loop, 1/(k tanh(k depth)): tile<i>_wave.bin
StructuredBuffer<float2> twiddle : register(t3); // cos, sin of 2 pi i / n: twiddle.bin
RWStructuredBuffer<float4> work : register(u4); // two a texel: four complex fields
RWStructuredBuffer<float4> maps : register(u5); // planes with all their levels
#ifdef FFTOCEAN_IMAGE_FORMAT // an attribute: SPIR-V names the format of the texture, DirectX does not
FFTOCEAN_IMAGE_FORMAT
#endif
RWTexture2D<float4> image : register(u6);
RWStructuredBuffer<float4> answers : register(u7); // two a point
StructuredBuffer<float2> places : register(t8); // of points, from the origin [m]

cbuffer Target : register(b9)
{
    uint target_plane, target_level;
    uint unused_3, unused_4;
};
#endif

groupshared float4 held[1024]; // two halves of PLACES; also the averages of `mips`

float2 times(float2 a, float2 b) { return float2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

float4 times_both(float2 w, float4 v) { return float4(times(w, v.xy), times(w, v.zw)); }

float2 times_i(float2 a) { return float2(-a.y, a.x); }

// Cosine and sine of a phase in turns, 0 to 1, to 1e-7: polynomials within an eighth of a turn of the nearest quarter.
float2 phasor(float turn)
{
    float quarter = floor(4.0 * turn + 0.5);
    float x = turn - 0.25 * quarter;
    float q = x * x;
    float s = x * (6.2831853 + q * (-41.341663 + q * (81.591983 + q * -75.369649)));
    float c = 1.0 + q * (-19.739209 + q * (64.939363 + q * (-85.447456 + q * 59.362561)));
    uint quadrant = uint(quarter);
    float2 turned = (quadrant & 1u) == 0u ? float2(c, s) : float2(-s, c);
    return (quadrant & 2u) == 0u ? turned : -turned;
}

// The whole wavenumber of an entry of a transform.
float whole(uint i, uint n) { return 2u * i < n ? float(i) : float(i) - float(n); }

// Inverse transforms, without 1/n, of the PLACES / n lines in group memory: radix-2 Stockham steps. Sample i of line l is at
// i * (PLACES / n) + l, so that the inputs of thread t's butterfly are always at t and at t + THREADS.
void transform(uint t, uint n)
{
    uint lines = PLACES / n;
    uint l = t & (lines - 1u);
    uint butterfly = t / lines;
    for (uint part = 1u; part < n; part = 2u * part)
    {
        uint r = butterfly & (part - 1u);
        float2 w = twiddle[r * (twiddles / (2u * part))];
        float4 a = held[t];
        float4 b = held[PLACES + t];
        float4 c = times_both(w, held[THREADS + t]);
        float4 d = times_both(w, held[PLACES + THREADS + t]);
        GroupMemoryBarrierWithGroupSync();
        uint to = (2u * butterfly - r) * lines + l;
        held[to] = a + c;
        held[PLACES + to] = b + d;
        held[to + part * lines] = a - c;
        held[PLACES + to + part * lines] = b - d;
        GroupMemoryBarrierWithGroupSync();
    }
}

// Texels of all levels of a plane.
uint texels_of_levels(uint nx, uint ny)
{
    uint sum = 1u;
    for (uint2 size = uint2(nx, ny); size.x * size.y > 1u; size = max(size / 2u, uint2(1u, 1u))) sum += size.x * size.y;
    return sum;
}

// h(k) at the tick from h0(k), and the transforms along x. Group (i, tile) has the texels from 512 i on: whole rows.
[numthreads(256, 1, 1)]
void rows(uint3 group : SV_GroupID, uint t : SV_GroupIndex)
{
    uint nx = table[group.y].nx;
    uint ny = table[group.y].ny;
    uint start = PLACES * group.x;
    if (start >= nx * ny) return;
    uint first = table[group.y].first;
    float4 lifts = table[group.y].lifts;
    uint lines = PLACES / nx;
    for (uint i = t; i < PLACES; i += THREADS)
    {
        uint texel = start + i;
        if (texel >= nx * ny) continue;
        uint x = texel & (nx - 1u);
        float4 amplitude = h0[first + texel];
        float2 cycles_and_factor = wave[first + texel];
        // Exact for ever: the product wraps at 2^32, and the ticks of a loop are a power of two.
        uint turn = (uint(cycles_and_factor.x) * tick) & mask;
        float2 e = phasor(float(turn) * turns_per_tick);
        float2 height = times(amplitude.xy, float2(e.x, -e.y)) + times(amplitude.zw, e);
        float2 potential = height * cycles_and_factor.y;
        float2 k = float2(whole(x, nx), whole(texel / nx, ny)) * table[group.y].dk;
        float2 displace_x = times_i(k.x * potential);
        float2 displace_y = times_i(k.y * potential);
        float2 slope_x = times_i(k.x * height);
        float2 slope_y = times_i(k.y * height);
        float2 stretch_xx = -k.x * k.x * potential;
        float2 stretch_xy = -k.x * k.y * potential;
        float2 stretch_yy = -k.y * k.y * potential;
        // Each part of a complex field comes out as a real one; a lift makes the second as large as the first.
        uint place = x * lines + i / nx;
        held[place] = float4(displace_x + lifts.x * times_i(displace_y), height + lifts.y * times_i(stretch_xy));
        held[PLACES + place] = float4(slope_x + lifts.z * times_i(slope_y), stretch_xx + lifts.w * times_i(stretch_yy));
    }
    GroupMemoryBarrierWithGroupSync();
    transform(t, nx);
    for (uint j = t; j < PLACES; j += THREADS)
    {
        uint made = start + j;
        if (made >= nx * ny) continue;
        uint from = (made & (nx - 1u)) * lines + j / nx;
        work[2u * (first + made)] = held[from];
        work[2u * (first + made) + 1u] = held[PLACES + from];
    }
}

// The transforms along y, and the three maps. Group (i, tile) has 512 / ny columns.
[numthreads(256, 1, 1)]
void columns(uint3 group : SV_GroupID, uint t : SV_GroupIndex)
{
    uint nx = table[group.y].nx;
    uint ny = table[group.y].ny;
    if (PLACES * group.x >= nx * ny) return;
    uint first = table[group.y].first;
    uint lines = PLACES / ny;
    for (uint i = t; i < PLACES; i += THREADS)
    {
        uint x = group.x * lines + (i & (lines - 1u));
        if (x >= nx) continue;
        uint at = 2u * (first + (i / lines) * nx + x);
        held[i] = work[at];
        held[PLACES + i] = work[at + 1u];
    }
    GroupMemoryBarrierWithGroupSync();
    transform(t, ny);
    // 1 / lift, to the bit: both are powers of two, and a division may be rounded.
    float4 lowered = asfloat((254u << 23u) - asuint(table[group.y].lifts));
    float c = choppiness;
    uint plane = texels_of_levels(nx, ny);
    for (uint j = t; j < PLACES; j += THREADS)
    {
        uint x = group.x * lines + (j & (lines - 1u));
        if (x >= nx) continue;
        float4 a = held[j];
        float4 b = held[PLACES + j];
        uint at = table[group.y].first_map + (j / lines) * nx + x;
        float2 slope = float2(b.x, b.y * lowered.z);
        maps[at] = float4(c * a.x, c * a.y * lowered.x, a.z, c * a.w * lowered.y);
        maps[at + plane] = float4(slope, c * b.z, c * b.w * lowered.w);
        maps[at + 2u * plane] = float4(slope * slope, slope.x * slope.y, 0.0);
    }
}

// Samples a side, and first texel, of a plane: three of each tile, then that of foam.
uint3 plane_at(uint index)
{
    if (index >= 3u * tiles) return uint3(foam_side, foam_side, foam_first);
    uint tile = index / 3u;
    uint nx = table[tile].nx;
    uint ny = table[tile].ny;
    return uint3(nx, ny, table[tile].first_map + (index % 3u) * texels_of_levels(nx, ny));
}

// Samples a side, and first texel, of the next level.
uint3 next_level(uint3 plane) { return uint3(max(plane.xy / 2u, uint2(1u, 1u)), plane.z + plane.x * plane.y); }

// Five levels from one: group (i, j, plane) has a block of 32 x 32 texels.
void average(uint3 group, uint t, uint base)
{
    uint3 below = plane_at(group.z);
    for (uint i = 0u; i < base; i++)
    {
        if (below.x * below.y == 1u) return;
        below = next_level(below);
    }
    if (any(32u * group.xy >= below.xy)) return;
    for (uint side = 16u; side > 0u; side = side / 2u)
    {
        if (below.x * below.y <= 1u) return;
        uint3 level = next_level(below);
        uint2 own = uint2(t % side, t / side); // in the block
        bool busy = own.y < side && all(side * group.xy + own < level.xy);
        uint2 low = 2u * own;
        uint2 high = min(low + 1u, min(uint2(2u * side, 2u * side), below.xy) - 1u);
        float4 sum = float4(0.0, 0.0, 0.0, 0.0);
        if (busy)
        {
            if (side == 16u)
            {
                uint at = below.z + 32u * (group.y * below.x + group.x);
                sum = maps[at + low.y * below.x + low.x] + maps[at + low.y * below.x + high.x]
                    + (maps[at + high.y * below.x + low.x] + maps[at + high.y * below.x + high.x]);
            }
            else
            {
                sum = held[16u * low.y + low.x] + held[16u * low.y + high.x]
                    + (held[16u * high.y + low.x] + held[16u * high.y + high.x]);
            }
        }
        GroupMemoryBarrierWithGroupSync();
        if (busy)
        {
            held[16u * own.y + own.x] = 0.25 * sum;
            maps[level.z + (side * group.y + own.y) * level.x + side * group.x + own.x] = 0.25 * sum;
        }
        GroupMemoryBarrierWithGroupSync();
        below = level;
    }
}

// Levels 1 to 5 of every plane, from level 0.
[numthreads(256, 1, 1)]
void mips(uint3 group : SV_GroupID, uint t : SV_GroupIndex) { average(group, t, 0u); }

// Levels 6 to 10, from level 5.
[numthreads(256, 1, 1)]
void mips_far(uint3 group : SV_GroupID, uint t : SV_GroupIndex) { average(group, t, 5u); }

// One level of a plane to a texture of its size.
[numthreads(8, 8, 1)]
void textures(uint3 id : SV_DispatchThreadID)
{
    uint3 level = plane_at(target_plane);
    for (uint i = 0u; i < target_level; i++) level = next_level(level);
    if (any(id.xy >= level.xy)) return;
    image[id.xy] = maps[level.z + id.y * level.x + id.x];
}

// One step of foam at rest positions: df/dt = -f / decay + strength max(threshold - lambda, 0), lambda the smallest eigenvalue of the
// deformation gradient of the SUM of all tiles (Tessendorf 2001). Between the two ends of the step lambda is linear in time.
// A cell takes the nearest texel of each tile, neither filtered nor interpolated.
[numthreads(8, 8, 1)]
void foam(uint3 id : SV_DispatchThreadID)
{
    uint side = foam_side;
    if (any(id.xy >= uint2(side, side))) return;
    // A cell of the world keeps its place while the window moves over it.
    int2 own = (int2(id.xy) - corner) & int2(side - 1u, side - 1u);
    float2 rest = corner_place + cell * float2(own);
    float3 stretch = float3(0.0, 0.0, 0.0);
    for (uint i = 0u; i < tiles; i++)
    {
        uint2 n = uint2(table[i].nx, table[i].ny);
        uint2 nearest = uint2(floor(frac(rest / table[i].size + table[i].origin) * float2(n) + 0.5)) & (n - 1u);
        uint texel = table[i].first_map + nearest.y * n.x + nearest.x;
        stretch += float3(maps[texel + texels_of_levels(n.x, n.y)].zw, maps[texel].w);
    }
    float middle = 1.0 + 0.5 * (stretch.x + stretch.y);
    float half_difference = 0.5 * (stretch.x - stretch.y);
    float now = threshold - (middle - sqrt(half_difference * half_difference + stretch.z * stretch.z));
    uint at = foam_first + id.y * side + id.x;
    float before = maps[at].z;
    float d = exp(-0.25 * seconds / decay); // what is left after a quarter of the step
    float made = 0.5 * d * d * d * d * max(before, 0.0) + d * d * d * max(lerp(before, now, 0.25), 0.0)
        + d * d * max(lerp(before, now, 0.5), 0.0) + d * max(lerp(before, now, 0.75), 0.0) + 0.5 * max(now, 0.0);
    float amount = d * d * d * d * maps[at].y + 0.25 * seconds * strength * made;
    int2 old = corner + own - corner_before;
    // A cell that enters the window has what a steady source would have left on it.
    if (any(old < int2(0, 0)) || any(old >= int2(side, side))) amount = decay * strength * max(now, 0.0);
    maps[at] = float4(1.0 - exp(-amount), amount, now, 0.0);
}

struct Water
{
    float2 moved;
    float height;
    float2 slope;
    float3 stretch;
};

// The sum of all tiles at a rest position. Height and displacement are cubic between the samples, from their values and gradients there
// (Adini's element); gradients are bilinear.
Water water_at(float2 rest)
{
    Water water;
    water.moved = float2(0.0, 0.0);
    water.height = 0.0;
    water.slope = float2(0.0, 0.0);
    water.stretch = float3(0.0, 0.0, 0.0);
    for (uint i = 0u; i < tiles; i++)
    {
        uint2 n = uint2(table[i].nx, table[i].ny);
        float2 place = frac(rest / table[i].size + table[i].origin) * float2(n);
        float2 spacing = table[i].size / float2(n);
        uint plane = texels_of_levels(n.x, n.y);
        for (uint j = 0u; j < 4u; j++)
        {
            uint2 side = uint2(j & 1u, j >> 1u);
            float2 p = abs(place - floor(place) - float2(side)); // from the corner, 0 to 1
            float2 rest_of = 1.0 - p;
            float bilinear = rest_of.x * rest_of.y;
            float value = bilinear * (1.0 + p.x + p.y - 2.0 * dot(p, p));
            float2 gradient = bilinear * p * rest_of * spacing * (1.0 - 2.0 * float2(side));
            uint2 texel = (uint2(floor(place)) + side) & (n - 1u);
            uint at = table[i].first_map + texel.y * n.x + texel.x;
            float4 a = maps[at];
            float4 b = maps[at + plane];
            water.moved += value * a.xy + float2(dot(gradient, float2(b.z, a.w)), dot(gradient, float2(a.w, b.w)));
            water.height += value * a.z + dot(gradient, b.xy);
            water.slope += bilinear * b.xy;
            water.stretch += bilinear * float3(b.zw, a.w);
        }
    }
    return water;
}

float jacobian_of(Water water)
{
    return (1.0 + water.stretch.x) * (1.0 + water.stretch.y) - water.stretch.z * water.stretch.z;
}

// The displaced surface above points of the world, by Newton's iteration on the rest position.
[numthreads(64, 1, 1)]
void heights(uint3 id : SV_DispatchThreadID)
{
    if (id.x >= points) return;
    float2 goal = places[id.x];
    float2 rest = goal;
    Water water = water_at(rest);
    for (uint i = 0u; i < iterations; i++)
    {
        float2 apart = rest + water.moved - goal;
        float determinant = max(jacobian_of(water), 0.2); // short steps near a fold
        float3 s = water.stretch;
        rest -= float2((1.0 + s.y) * apart.x - s.z * apart.y, (1.0 + s.x) * apart.y - s.z * apart.x) / determinant;
        water = water_at(rest);
    }
    float3 s = water.stretch;
    float3 normal = float3(s.z * water.slope.y - (1.0 + s.y) * water.slope.x, s.z * water.slope.x - (1.0 + s.x) * water.slope.y,
        jacobian_of(water));
    answers[2u * id.x] = float4(rest, water.height, length(rest + water.moved - goal));
    answers[2u * id.x + 1u] = float4(normal / max(length(normal), 1e-20), jacobian_of(water));
}
