// Particles by WebGL2: disks of their true radius in 2D, shaded spheres with shadows in 3D, as in
// mpm_taichi/renderers.  Each is a square of two triangles that holds its disk; spheres are drawn
// from back to front.  Vertices take their particle from textures: drawing it as an instance of
// so few vertices is slow.

const ROW = 1024;  // particles in a row of the textures

const HAZE = 0.25;    // of the background in the color of a particle at the back
const SHADOW = 0.75;  // of its color in what lies in the shadow

/** Particles in the whole rows that hold n. */
const wholeRows = n => Math.ceil(n / ROW) * ROW;

const VERTEX = `#version 300 es
precision highp float;
const int ROW = ${ROW};
const float HAZE = ${HAZE.toFixed(2)};
uniform highp sampler2D places;          // x, y, z, radius [m]
uniform sampler2D colors;
uniform mat3 axes;                       // rows: to the right, up, toward the viewer
uniform vec3 center;                     // m
uniform vec3 domain;                     // m
uniform float perDistance;               // 1 / m, 0 in 2D
uniform float scale;                     // pixels per m at the center
uniform vec2 middle, stage;              // pixels
uniform float halfDepth;                 // m
uniform bool shadow, spheres;
out vec2 offset;                         // pixels from the middle of the disk
flat out float reach;                    // its radius in pixels
flat out vec4 shade;

void main() {
  int particle = gl_VertexID / 6, which = gl_VertexID % 6;
  ivec2 texel = ivec2(particle % ROW, particle / ROW);
  vec4 place = texelFetch(places, texel, 0);
  vec3 position = place.xyz;
  float radius = place.w;
  vec2 corner = vec2(which == 1 || which > 3, which == 2 || which == 3 || which == 5) * 2.0 - 1.0;
  vec3 seen = axes * (position - center);
  float near = 1.0 - seen.z * perDistance;
  float pixels = scale / max(near, 0.1);
  reach = radius * pixels;
  if (!spheres) reach *= 1.0 + 0.41421356 * clamp(2.0 - reach / 2.0, 0.0, 1.0);
  reach = max(reach, 0.7);
  offset = corner * (reach + 1.0);
  vec2 at = middle + vec2(seen.x, -seen.y) * pixels + offset;
  bool hidden = near < 0.1 || radius <= 0.0;
  if (shadow) {  // on the floor, where it lies flat
    vec3 spot = vec3(position.x, 0.0, position.z);
    hidden = hidden || any(lessThan(spot, vec3(0.0))) || any(greaterThan(spot, domain));
    float grown = radius * (reach + 1.0) / reach;
    seen = axes * (spot + grown * vec3(corner.x, 0.0, corner.y) - center);
    pixels = scale / max(1.0 - seen.z * perDistance, 0.1);
    at = middle + vec2(seen.x, -seen.y) * pixels;
  }
  shade = texelFetch(colors, texel, 0);
  if (spheres) shade.a = 1.0 - HAZE * (1.0 - clamp(0.5 + 0.5 * seen.z / halfDepth, 0.0, 1.0));
  vec2 clip = at / stage * 2.0 - 1.0;
  gl_Position = hidden ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(clip.x, -clip.y, 0.0, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec2 offset;
flat in float reach;
flat in vec4 shade;
uniform bool shadow, spheres;
uniform vec4 shadowColor;
uniform vec3 haze;
out vec4 pixel;

void main() {
  float coverage = clamp(reach + 0.5 - length(offset), 0.0, 1.0);
  if (coverage <= 0.0) discard;
  if (shadow) {
    pixel = shadowColor * coverage;
  } else if (spheres) {
    vec2 on = vec2(offset.x, -offset.y) / reach;
    float z = sqrt(max(0.0, 1.0 - dot(on, on)));
    float diffuse = max(0.0, dot(vec3(-0.40, 0.68, 0.61), vec3(on, z)));
    vec3 color = mix(haze, shade.rgb, shade.a) * (0.52 + 0.62 * diffuse) * (0.8 + 0.2 * z);
    pixel = vec4(min(color, 1.0) * coverage, coverage);
  } else {
    pixel = vec4(shade.rgb * coverage, coverage);
  }
}`;

class Painter {
  /** Throws what WebGL says where it cannot be used. */
  constructor(canvas, film, theme) {
    const gl = canvas.getContext("webgl2", { alpha: true, antialias: false, depth: false });
    if (!gl) throw new Error("This browser has no WebGL2");
    Object.assign(this, { canvas, gl, theme, count: film.particles });
    this.spheres = film.dimension == 3;
    this.program = this.link(VERTEX, FRAGMENT);
    this.uniforms = {};
    for (let i = 0; i < gl.getProgramParameter(this.program, gl.ACTIVE_UNIFORMS); i++) {
      const { name } = gl.getActiveUniform(this.program, i);
      this.uniforms[name] = gl.getUniformLocation(this.program, name);
    }
    this.rows = wholeRows(this.count) / ROW;
    this.texture(0, gl.RGBA32F);
    this.texture(1, gl.RGBA8);
    gl.useProgram(this.program);
  }

  link(...texts) {
    const gl = this.gl, program = gl.createProgram();
    [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER].forEach((kind, i) => {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, texts[i]);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    });
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      const logs = gl.getAttachedShaders(program).map(shader => gl.getShaderInfoLog(shader));
      throw new Error(["WebGL2 does not compile", ...logs].join(" "));
    }
    return program;
  }

  texture(unit, format) {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texStorage2D(gl.TEXTURE_2D, 1, format, ROW, this.rows);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  upload(unit, kind, values) {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, ROW, this.rows, gl.RGBA, kind, values);
  }

  /** Places [n, 4] (x, y, z and radius in m) and colors [n, 4] in bytes, both as long as whole rows
   *  of particles, as the camera sees them. */
  draw(places, colors, camera, pixelRatio) {
    const gl = this.gl, u = this.uniforms, { canvas, spheres } = this, { center } = camera.view;
    const outside = center.map((at, axis) => at - camera.size[axis] / 2);
    const halfDepth = Math.hypot(...camera.size) / 2 + Math.hypot(...outside);
    if (spheres) {
      const order = backToFront(this.count, places, camera.axes[2], center, halfDepth);
      places = inOrder(places, order);
      colors = inOrder(colors, order);
    }
    this.upload(0, gl.FLOAT, places);
    this.upload(1, gl.UNSIGNED_BYTE, colors);
    gl.uniform1i(u.places, 0);
    gl.uniform1i(u.colors, 1);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.uniformMatrix3fv(u.axes, true, camera.axes.flat());
    gl.uniform3fv(u.center, center);
    gl.uniform3fv(u.domain, camera.size);
    gl.uniform1f(u.perDistance, 1 / camera.distance);
    gl.uniform1f(u.scale, camera.scale * pixelRatio);
    gl.uniform2f(u.middle, camera.column * pixelRatio, camera.row * pixelRatio);
    gl.uniform2f(u.stage, canvas.width, canvas.height);
    gl.uniform1f(u.halfDepth, halfDepth);
    gl.uniform1i(u.spheres, spheres);
    gl.uniform3fv(u.haze, this.theme.panel);
    gl.uniform4fv(u.shadowColor, [...this.theme.shadow, 1].map(part => SHADOW * part));
    for (const shadow of spheres ? [true, false] : [false]) {
      gl.uniform1i(u.shadow, shadow);
      gl.drawArrays(gl.TRIANGLES, 0, 6 * this.count);
    }
  }
}

/** The numbers of the n particles, the farthest first: a counting sort. */
function backToFront(n, places, toward, center, halfDepth) {
  const keys = new Uint16Array(n), starts = new Uint32Array(65537);
  const factor = 32767 / halfDepth, shift = 32767 - factor * dot(toward, center);
  for (let p = 0, i = 0; p < n; p++, i += 4) {
    const x = toward[0] * places[i] + toward[1] * places[i + 1] + toward[2] * places[i + 2];
    keys[p] = Math.min(Math.max(factor * x + shift, 0), 65535);
    starts[keys[p] + 1]++;
  }
  for (let key = 0; key < 65536; key++) starts[key + 1] += starts[key];
  const order = new Uint32Array(n);
  for (let p = 0; p < n; p++) order[starts[keys[p]]++] = p;
  return order;
}

/** Rows of four numbers in a new order. */
function inOrder(values, order) {
  const sorted = new values.constructor(values.length);
  for (let i = 0, to = 0; i < order.length; i++)
    for (let from = 4 * order[i], end = from + 4; from < end; from++) sorted[to++] = values[from];
  return sorted;
}
