// Draws skies with WebGL 2: each sky is a texture of half floats, so that looking around costs nothing.

import { BAND_VALUES } from "./colour.js";
import { basis, halfHeight } from "./geometry.js";
import { FRAGMENT, VERTEX, VIEWS } from "./shaders.js";

const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1];
const SUN_RADIUS = 0.00465;
// Angle that the height of a view covers, about.
const PIXEL_SPANS = {
  look: (half) => 2 * half,
  set: (half) => 2 * half,
  equirect: () => Math.PI,
  fisheye: () => Math.PI,
  planet: () => 1,
  cross: () => (3 * Math.PI) / 2,
};
const SET_HALF_WIDTH = 0.41;

/** Error of a browser that cannot draw. */
export class NoWebGlError extends Error {}

export class Renderer {
  #skies = new Map();
  #uniforms = new Map();

  constructor(canvas) {
    this.canvas = canvas;
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, preserveDrawingBuffer: true });
    if (!gl) throw new NoWebGlError("This browser has no WebGL 2, with which the sky is drawn.");
    this.gl = gl;
    this.program = linked(gl);
    gl.useProgram(this.program);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    this.#set("sky", "uniform1i", 0);
    this.#set("table", "uniform1i", 1);
    this.#set("bands", "uniform3fv", new Float32Array(BAND_VALUES));
  }

  /** Keep a picture under a name. */
  setSky(name, frame) {
    const { gl } = this;
    const old = this.#skies.get(name);
    const texture = old?.texture ?? gl.createTexture();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    const wrap = frame.kind === "planet" ? gl.CLAMP_TO_EDGE : gl.REPEAT;
    filtered(gl, gl.TEXTURE_2D, [wrap, gl.CLAMP_TO_EDGE]);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB16F, frame.width, frame.height, 0, gl.RGB, gl.HALF_FLOAT, frame.drawn ?? frame.texels);
    this.#skies.set(name, { texture, lighting: frame.lighting });
  }

  hasSky(name) {
    return this.#skies.has(name);
  }

  /** Take a display transform's table. */
  setDisplay({ size, texels, middle, min_ev: least, max_ev: most, matrix }) {
    const { gl } = this;
    this.table ??= gl.createTexture();
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_3D, this.table);
    filtered(gl, gl.TEXTURE_3D, [gl.CLAMP_TO_EDGE, gl.CLAMP_TO_EDGE, gl.CLAMP_TO_EDGE]);
    gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGB16F, size, size, size, 0, gl.RGB, gl.HALF_FLOAT, texels);
    this.#set("shaper", "uniform4f", middle, least, most, size);
    this.#matrix("toTable", matrix ?? IDENTITY);
  }

  /** Fit the canvas to its place on the screen; whether that changed it. */
  fit() {
    const scale = Math.min(devicePixelRatio, 2);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * scale));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * scale));
    if (this.canvas.width === width && this.canvas.height === height) return false;
    Object.assign(this.canvas, { width, height });
    return true;
  }

  clear() {
    const { gl } = this;
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(0, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  /**
   * Draw a sky into a rectangle [x, y, width, height] of the canvas, from its upper left; of it,
   * what is within `clip`. Returns whether it was there to be drawn.
   */
  draw(name, { kind, camera, gain, balance, isFalse, rectangle, clip = rectangle }) {
    const sky = this.#skies.get(name);
    if (!sky || !this.table) return false;
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, sky.texture);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_3D, this.table);
    gl.enable(gl.SCISSOR_TEST);
    gl.viewport(...this.#fromBelow(rectangle));
    gl.scissor(...this.#fromBelow(clip));
    this.#set("view", "uniform1i", VIEWS[kind]);
    this.#set("isFalse", "uniform1i", Number(isFalse));
    this.#set("gain", "uniform1f", gain);
    this.#matrix("balance", balance ?? IDENTITY);
    this.#camera(kind, camera, rectangle[2] / rectangle[3], rectangle[3]);
    this.#sun(sky.lighting);
    if (kind === "set") this.#lights(sky.lighting, camera);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    return true;
  }

  /** Fill a rectangle with one colour. */
  fill(rectangle, colour) {
    const { gl } = this;
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(...this.#fromBelow(rectangle));
    gl.clearColor(...colour, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  #camera(kind, camera, aspect, height) {
    const { right, up, forward } = basis(camera);
    const half = kind === "set" ? Math.max(SET_HALF_WIDTH / aspect, 0.24) : halfHeight(camera, aspect);
    this.#set("halfAngle", "uniform2f", half * aspect, half);
    this.#set("pixel", "uniform1f", PIXEL_SPANS[kind](half) / height);
    this.#set("right", "uniform3f", ...right);
    this.#set("up", "uniform3f", ...up);
    this.#set("forward", "uniform3f", ...forward);
  }

  // Planets from afar have none: their pictures hold all that is to be seen.
  #sun({ sunlight, sunward, disc } = {}) {
    const { radiance = [0, 0, 0], radius = SUN_RADIUS, floor = -1 } = disc ?? {};
    this.#set("discLight", "uniform3f", ...radiance);
    this.#set("sunRadius", "uniform1f", radius);
    this.#set("sunFloor", "uniform1f", floor);
    this.#set("sunlight", "uniform3f", ...(sunlight ?? [0, 0, 0]));
    this.#set("sunward", "uniform3f", ...(sunward ?? [0, -1, 0]));
  }

  #lights({ harmonics }, camera) {
    const level = basis({ azimuth: camera.azimuth, elevation: 0 });
    this.#set("harmonics", "uniform3fv", new Float32Array(harmonics.flat()));
    this.#set("onRight", "uniform3f", ...level.right);
    this.#set("onForward", "uniform3f", ...level.forward);
  }

  #set(name, how, ...values) {
    if (!this.#uniforms.has(name)) this.#uniforms.set(name, this.gl.getUniformLocation(this.program, name));
    this.gl[how](this.#uniforms.get(name), ...values);
  }

  #matrix(name, rows) {
    this.#set(name, "uniformMatrix3fv", true, new Float32Array(rows));
  }

  #fromBelow([x, y, width, height]) {
    const upper = Math.round(y);
    const lower = Math.round(y + height);
    const left = Math.round(x);
    return [left, this.canvas.height - lower, Math.round(x + width) - left, lower - upper];
  }
}

function filtered(gl, target, wraps) {
  gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
  [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R].slice(0, wraps.length).forEach((axis, index) => gl.texParameteri(target, axis, wraps[index]));
}

function linked(gl) {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new NoWebGlError(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new NoWebGlError(gl.getProgramInfoLog(program));
  return program;
}
