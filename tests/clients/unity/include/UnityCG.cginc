// The names of UnityCG.cginc that examples/unity uses, for a compiler without Unity.
float4x4 unity_ObjectToWorld, UNITY_MATRIX_VP;
float3 _WorldSpaceCameraPos;
