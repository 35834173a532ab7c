// Particles by WebGL2: disks of their true radius in 2D, shaded spheres with shadows in 3D, as in
// mpm_taichi/renderers.  Each is one instance of a square that holds its disk; spheres are drawn from
// back to front.

const VERTEX = `#version 300 es
precision highp float;
layout(location = 0) in vec2 corner;     // -1 or 1
layout(location = 1) in vec3 position;   // m
layout(location = 2) in float radius;    // m
layout(location = 3) in vec4 color;
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
  vec3 seen = axes * (position - center);
  float near = 1.0 - seen.z * perDistance;
  float pixels = scale / max(near, 0.1);
  reach = radius * pixels;
  if (!spheres) reach *= 1.0 + 0.41421356 * clamp(2.0 - reach / 2.0, 0.0, 1.0);
  reach = max(reach, 0.7);
  offset = corner * (reach + 1.0);
  vec2 at = middle + vec2(seen.x, -seen.y) * pixels + offset;
  bool hidden = near < 0.1;
  if (shadow) {  // on the floor, where it lies flat
    vec3 spot = vec3(position.x, 0.0, position.z);
    hidden = hidden || any(lessThan(spot, vec3(0.0))) || any(greaterThan(spot, domain));
    float grown = radius * (reach + 1.0) / reach;
    seen = axes * (spot + grown * vec3(corner.x, 0.0, corner.y) - center);
    pixels = scale / max(1.0 - seen.z * perDistance, 0.1);
    at = middle + vec2(seen.x, -seen.y) * pixels;
  }
  shade = color;
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

const HAZE = 0.25;    // of the background in the color of a particle at the back
const SHADOW = 0.75;  // of its color in what lies in the shadow

class Painter {
  /** Throws what WebGL says where it cannot be used. */
  constructor(canvas, film, theme) {
    const gl = canvas.getContext("webgl2", { alpha: true, antialias: false, depth: false });
    if (!gl) throw new Error("This browser has no WebGL2");
    Object.assign(this, { canvas, gl, theme, radius: film.radius, count: film.particles });
    this.spheres = film.dimension == 3;
    this.program = this.link(VERTEX.replace("HAZE", HAZE.toFixed(2)), FRAGMENT);
    this.uniforms = {};
    for (let i = 0; i < gl.getProgramParameter(this.program, gl.ACTIVE_UNIFORMS); i++) {
      const { name } = gl.getActiveUniform(this.program, i);
      this.uniforms[name] = gl.getUniformLocation(this.program, name);
    }
    this.attribute(0, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), 2, gl.FLOAT, 0);
    this.positions = this.attribute(1, 12 * this.count, 3, gl.FLOAT, 1);
    this.radii = this.attribute(2, film.radius, 1, gl.FLOAT, 1);
    this.colors = this.attribute(3, 4 * this.count, 4, gl.UNSIGNED_BYTE, 1);
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

  attribute(place, data, size, kind, divisor) {
    const gl = this.gl, buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, kind, kind == gl.UNSIGNED_BYTE, 0, 0);
    gl.vertexAttribDivisor(place, divisor);
    return buffer;
  }

  /** Positions [n, 3] in m and colors [n, 4] in bytes, as the camera sees them. */
  draw(positions, colors, camera, pixelRatio) {
    const gl = this.gl, u = this.uniforms, { canvas, spheres } = this, { center } = camera.view;
    const outside = center.map((at, axis) => at - camera.size[axis] / 2);
    const halfDepth = Math.hypot(...camera.size) / 2 + Math.hypot(...outside);
    const parts = [[this.positions, positions, 3], [this.colors, new Uint32Array(colors.buffer), 1]];
    if (spheres) {
      const order = backToFront(positions, camera.axes[2], center, halfDepth);
      parts.push([this.radii, this.radius, 1]);
      for (const part of parts) part[1] = inOrder(part[1], order, part[2]);
    }
    for (const [buffer, values] of parts) {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, values);
    }
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
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.count);
    }
  }
}

/** The numbers of the particles, the farthest first: a counting sort. */
function backToFront(positions, toward, center, halfDepth) {
  const n = positions.length / 3, keys = new Uint16Array(n), starts = new Uint32Array(65537);
  const factor = 32767 / halfDepth, shift = 32767 - factor * dot(toward, center);
  for (let p = 0, i = 0; p < n; p++, i += 3) {
    const x = toward[0] * positions[i] + toward[1] * positions[i + 1] + toward[2] * positions[i + 2];
    keys[p] = Math.min(Math.max(factor * x + shift, 0), 65535);
    starts[keys[p] + 1]++;
  }
  for (let key = 0; key < 65536; key++) starts[key + 1] += starts[key];
  const order = new Uint32Array(n);
  for (let p = 0; p < n; p++) order[starts[keys[p]]++] = p;
  return order;
}

/** Rows of `width` numbers in a new order. */
function inOrder(values, order, width) {
  const sorted = new values.constructor(values.length);
  for (let i = 0, to = 0; i < order.length; i++)
    for (let from = order[i] * width, end = from + width; from < end; from++) sorted[to++] = values[from];
  return sorted;
}
