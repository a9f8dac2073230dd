// Not run in Unity: compiled by glslang. The surface of the sea of SeaSurface, for any shader.
//
// Shader Graph: Custom Function nodes of this file. SeaMove (Vertex stage) takes the position in the
// world and uv0.x, the spacing of the mesh, and gives the moved position and its place at rest;
// SeaShade (Fragment stage) takes the place at rest. Precision: Single.
#ifndef FFTOCEAN_SEA_WATER
#define FFTOCEAN_SEA_WATER

float4 _SeaEye; // position of the camera; number of tiles
float4 _SeaFoamWindow; // side [m]; 1 if there is foam
float4 _SeaTile0, _SeaTile1, _SeaTile2, _SeaTile3; // sides [m]; the camera's place in the tile
float4 _SeaTexels0, _SeaTexels1, _SeaTexels2, _SeaTexels3; // samples
SamplerState sampler_SeaMoved0; // that of each texture: repeat, trilinear, anisotropic
Texture2D _SeaMoved0, _SeaMoved1, _SeaMoved2, _SeaMoved3; // c dx, c dy, height, c dxy
Texture2D _SeaSlopes0, _SeaSlopes1, _SeaSlopes2, _SeaSlopes3; // slopes x, y; c dxx, c dyy
Texture2D _SeaMoments0, _SeaMoments1, _SeaMoments2, _SeaMoments3; // slopes: xx, yy, xy
Texture2D _SeaFoam;

// Coordinates in a tile of a place (x east, z north) in the world.
float2 SeaPlace(float2 rest, float4 tile) { return (rest - _SeaEye.xz) / tile.xy + tile.zw; }

float SeaLevel(float spacing, float4 tile, float4 texels)
{
    return max(0.0, log2(spacing * max(texels.x / tile.x, texels.y / tile.y)));
}

#define SEA_TILES(DO) DO(0) DO(1) DO(2) DO(3)

// The place now of the water that rests at `rest`; waves shorter than the spacing are left out.
void SeaMove_float(float3 Position, float Spacing, out float3 Moved, out float2 Rest)
{
    Rest = Position.xz;
    float3 sum = float3(0.0, 0.0, 0.0);
#define SEA_MOVE(i) if (i < int(_SeaEye.w)) sum += _SeaMoved##i.SampleLevel(sampler_SeaMoved0, \
    SeaPlace(Rest, _SeaTile##i), SeaLevel(Spacing, _SeaTile##i, _SeaTexels##i)).xyz;
    SEA_TILES(SEA_MOVE)
    Moved = Position + float3(sum.x, sum.z, sum.y);
}

// The unit normal there; the variance of slopes within a pixel, along x and y of the sea and mixed;
// and the coverage by foam. Slopes and their moments add up over tiles, normals do not.
void SeaShade_float(float2 Rest, out float3 Normal, out float3 Roughness, out float Foam)
{
    float2 slope = float2(0.0, 0.0);
    float3 stretch = float3(0.0, 0.0, 0.0);
    Roughness = float3(0.0, 0.0, 0.0);
    // Gradients of the place in the world: those of coordinates jump where a tile repeats.
    float2 dx = ddx(Rest), dy = ddy(Rest);
#define SEA_SHADE(i) if (i < int(_SeaEye.w)) { \
    float2 uv = SeaPlace(Rest, _SeaTile##i), gx = dx / _SeaTile##i.xy, gy = dy / _SeaTile##i.xy; \
    float4 slopes = _SeaSlopes##i.SampleGrad(sampler_SeaMoved0, uv, gx, gy); \
    float3 moments = _SeaMoments##i.SampleGrad(sampler_SeaMoved0, uv, gx, gy).xyz; \
    slope += slopes.xy; \
    stretch += float3(slopes.zw, _SeaMoved##i.SampleGrad(sampler_SeaMoved0, uv, gx, gy).w); \
    Roughness += moments - float3(slopes.xy * slopes.xy, slopes.x * slopes.y); }
    SEA_TILES(SEA_SHADE)
    float2 along = 1.0 + stretch.xy;
    float3 n = float3(stretch.z * slope.y - along.y * slope.x,
        stretch.z * slope.x - along.x * slope.y, along.x * along.y - stretch.z * stretch.z);
    n.z = max(n.z, 0.05); // in a fold
    Normal = normalize(float3(n.x, n.z, n.y)); // y is up, z north
    Roughness.xy = max(Roughness.xy, float2(0.0, 0.0));
    Foam = 0.0;
    if (_SeaFoamWindow.y > 0.0)
    {
        float2 off = abs(Rest - _SeaEye.xz) / (0.5 * _SeaFoamWindow.x);
        float inside = 1.0 - smoothstep(0.8, 0.98, max(off.x, off.y));
        float2 side = _SeaFoamWindow.xx;
        Foam = inside * _SeaFoam.SampleGrad(sampler_SeaMoved0, Rest / side, dx / side, dy / side).x;
    }
}
#endif
