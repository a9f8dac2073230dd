// Not run in Unity: its HLSL is compiled by glslang with stubs of UnityCG.cginc.
// Water for the built-in pipeline and for URP: one unlit pass. For lit water make a Shader Graph of
// the functions in SeaWater.hlsl.
Shader "FFTocean/SeaWater"
{
    Properties
    {
        _Deep ("Light from below", Color) = (0.01, 0.05, 0.07, 1)
        _Sky ("Sky above", Color) = (0.25, 0.45, 0.75, 1)
        _Horizon ("Sky at the horizon", Color) = (0.75, 0.83, 0.9, 1)
        _Sun ("Sun, brightness", Color) = (1, 0.95, 0.85, 20)
        _ToSun ("Direction to the sun", Vector) = (0.5, 0.35, 0.6, 0)
        _Beyond ("Slope variance beyond the tiles", Float) = 0.005
    }
    SubShader
    {
        Tags { "RenderType" = "Opaque" "Queue" = "Geometry" }
        Pass
        {
            Cull Off
            HLSLPROGRAM
            #pragma target 4.5
            #pragma vertex Vertex
            #pragma fragment Fragment
            #include "UnityCG.cginc"
            #include "SeaWater.hlsl"
            float4 _Deep, _Sky, _Horizon, _Sun, _ToSun;
            float _Beyond;

            struct Between
            {
                float4 position : SV_POSITION;
                float3 world : TEXCOORD0;
                float2 rest : TEXCOORD1;
            };

            Between Vertex(float4 vertex : POSITION, float2 uv : TEXCOORD0)
            {
                Between between;
                float3 world = mul(unity_ObjectToWorld, vertex).xyz;
                SeaMove_float(world, uv.x, between.world, between.rest);
                between.position = mul(UNITY_MATRIX_VP, float4(between.world, 1.0));
                return between;
            }

            float3 SkyAt(float3 direction)
            {
                return lerp(_Horizon.rgb, _Sky.rgb, pow(saturate(direction.y), 0.5));
            }

            float4 Fragment(Between between) : SV_Target
            {
                float3 normal, roughness;
                float foam;
                SeaShade_float(between.rest, normal, roughness, foam);
                float3 view = normalize(_WorldSpaceCameraPos - between.world);
                float facing = saturate(dot(view, normal));
                float variance = 0.5 * (roughness.x + roughness.y) + _Beyond;
                // Fresnel of a rough sea: Bruneton, Neyret and Holzschuch 2010
                float fresnel = 0.02 + 0.98 * pow(1.0 - facing, 5.0 * exp(-2.69 * sqrt(variance)))
                    / (1.0 + 22.7 * pow(variance, 0.75));
                float3 mirrored = reflect(-view, normal);
                mirrored.y = abs(mirrored.y); // else it meets another wave
                float3 light = lerp(_Deep.rgb, SkyAt(mirrored), fresnel);
                float3 toSun = normalize(_ToSun.xyz), middle = normalize(view + toSun);
                float3 facet = middle - normal * dot(middle, normal);
                float slope = dot(facet, facet) / max(dot(middle, normal) * dot(middle, normal), 1e-4);
                float glint = exp(-0.5 * slope / variance) / (6.2831853 * variance);
                light += _Sun.rgb * _Sun.a * 0.001 * glint;
                float3 white = 0.6 * (SkyAt(float3(0.0, 1.0, 0.0)) + _Sun.rgb * saturate(toSun.y));
                light = lerp(light, white, saturate(foam));
                return float4(light, 1.0);
            }
            ENDHLSL
        }
    }
}
