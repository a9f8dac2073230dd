// The first lines of every shader, and the vertex shader of whatever covers its target.

/** The first lines of every vertex shader that does more. */
export const VERTEX_HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
`;

/** The first lines of every fragment shader. */
export const FRAGMENT_HEAD = VERTEX_HEAD;

/** A triangle that covers the viewport; it needs no buffer. */
export const FULLSCREEN_VERTEX = `${VERTEX_HEAD}
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(corner * 4.0 - 1.0, 0.0, 1.0);
}`;
