// What the graphics card runs: a sky looked up by direction, balls lit by it, and how it is shown.

export const VERTEX = `#version 300 es
out vec2 place;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  place = vec2(corner.x, 1.0 - corner.y);
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}`;

/** Kinds of view by the number that the shader knows them by. */
export const VIEWS = { look: 0, equirect: 1, cross: 2, fisheye: 3, planet: 4, set: 5 };

const HEAD = `#version 300 es
precision highp float;
precision highp sampler2D;
precision highp sampler3D;
in vec2 place;
out vec4 colour;
uniform sampler2D sky;
uniform sampler3D table;
uniform int view;
uniform bool isFalse;
uniform float gain;
uniform mat3 balance, toTable;
uniform vec4 shaper;           // middle, least and most stops, size of the table
uniform vec3 right, up, forward;
uniform vec2 halfAngle;        // tangents, across and up
uniform vec3 bands[17];
uniform vec3 harmonics[9];     // irradiance without the sun
uniform vec3 sunward, sunlight, discLight;
uniform float sunRadius, sunFloor; // and the sine of the elevation below which it is hidden
uniform vec3 onRight, onForward;

const float PI = 3.141592653589793;

uniform float pixel;           // angle of one, about

vec3 withoutSun(vec3 d) {
  vec2 at = vec2(atan(d.x, -d.z) / (2.0 * PI), acos(clamp(d.y, -1.0, 1.0)) / PI);
  return textureLod(sky, at, 0.0).rgb;
}

// Share of a pixel that the disc covers. An outline by angles is round at every zoom; texels as
// large as the disc are not.
float sunShare(vec3 d) {
  float away = length(cross(d, sunward)), soft = max(0.7 * pixel, 0.02 * sunRadius);
  if (dot(d, sunward) < 0.0) return 0.0;
  float share = 1.0 - smoothstep(sunRadius - soft, sunRadius + soft, away);
  return share * smoothstep(sunFloor - soft, sunFloor + soft, d.y);
}

vec3 lookUp(vec3 d) {
  return withoutSun(d) + discLight * sunShare(d);
}
`;

const SHOWN = `
vec3 falseColour(vec3 light) {
  float stops = log2(max(dot(light, vec3(0.2126, 0.7152, 0.0722)), 1e-30) / shaper.x);
  return bands[int(clamp(floor(stops + 0.5), -8.0, 8.0)) + 8];
}

vec3 shown(vec3 light) {
  vec3 exposed = light * gain;
  if (isFalse) return falseColour(exposed);
  vec3 scene = toTable * clamp(balance * exposed, -1e6, 1e6);
  vec3 stops = log2(max(scene, 1e-12) / shaper.x);
  vec3 t = clamp((stops - shaper.y) / (shaper.z - shaper.y), 0.0, 1.0);
  return texture(table, (t * (shaper.w - 1.0) + 0.5) / shaper.w).rgb;
}

// A disc that is a thousand times too bright has stairs unless its share is taken of what is shown.
vec3 seen(vec3 d) {
  vec3 light = withoutSun(d);
  float share = sunShare(d);
  vec3 around = shown(light);
  return share > 0.0 && discLight != vec3(0.0) ? mix(around, shown(light + discLight), share) : around;
}
`;

const BALLS = `
const float RADIUS = 0.5;
const float STAGE = 2.1;
const vec3 GREY = vec3(0.18);

vec3 irradiance(vec3 n) {
  return max(vec3(0.0), harmonics[0]
    + harmonics[1] * n.y + harmonics[2] * n.z + harmonics[3] * n.x
    + harmonics[4] * n.x * n.y + harmonics[5] * n.y * n.z
    + harmonics[6] * (3.0 * n.z * n.z - 1.0)
    + harmonics[7] * n.x * n.z + harmonics[8] * (n.x * n.x - n.y * n.y));
}

vec3 centre(int ball) {
  return vec3(0.0, RADIUS, 0.0) + onRight * (ball == 0 ? -0.66 : 0.66);
}

float sphere(vec3 from, vec3 d, vec3 c) {
  vec3 o = from - c;
  float b = dot(o, d), disc = b * b - dot(o, o) + RADIUS * RADIUS;
  if (disc < 0.0) return -1.0;
  float t = -b - sqrt(disc);
  return t > 1e-4 ? t : -1.0;
}

// Share of the sun's disc that the balls leave.
float lit(vec3 p) {
  float share = 1.0;
  for (int i = 0; i < 2; i++) {
    vec3 to = centre(i) - p;
    float distance = length(to);
    if (distance < RADIUS * 1.002) continue;
    float between = acos(clamp(dot(to / distance, sunward), -1.0, 1.0));
    float extent = asin(RADIUS / distance);
    share *= smoothstep(extent - sunRadius, extent + sunRadius, between);
  }
  return share;
}

// Share of the sky that the balls leave to the ground, by the cosine of where each stands.
float open(vec3 p) {
  float share = 1.0;
  for (int i = 0; i < 2; i++) {
    vec3 to = centre(i) - p;
    float square = dot(to, to);
    share -= max(0.0, to.y) * RADIUS * RADIUS / (square * sqrt(square));
  }
  return max(0.0, share);
}

vec3 onGround(vec3 p, vec3 d) {
  vec3 n = vec3(0.0, 1.0, 0.0);
  vec3 light = irradiance(n) * open(p) + sunlight * max(0.0, sunward.y) * lit(p);
  float edge = smoothstep(STAGE, STAGE * 0.985, length(p.xz));
  return mix(lookUp(d), GREY / PI * light, edge);
}

vec3 onGrey(vec3 p) {
  vec3 n = (p - centre(0)) / RADIUS;
  // The card below is darker than most ground, and the ball hides it from the sky.
  float down = 0.5 - 0.5 * n.y;
  vec3 bounce = GREY * (irradiance(vec3(0.0, 1.0, 0.0)) + sunlight * max(0.0, sunward.y));
  vec3 light = irradiance(n) * (1.0 - down * down) + bounce * down * down
    + sunlight * max(0.0, dot(n, sunward)) * lit(p + n * 2e-3);
  return GREY / PI * light;
}

vec3 beyond(vec3 from, vec3 d) {
  if (d.y < -1e-4) {
    vec3 p = from - d * (from.y / d.y);
    if (length(p.xz) < STAGE) return onGround(p, d);
  }
  return lookUp(d);
}

vec3 traced(vec3 from, vec3 d) {
  float grey = sphere(from, d, centre(0)), mirror = sphere(from, d, centre(1));
  if (grey > 0.0 && (mirror < 0.0 || grey < mirror)) return onGrey(from + d * grey);
  if (mirror < 0.0) return beyond(from, d);
  vec3 p = from + d * mirror, n = (p - centre(1)) / RADIUS, r = reflect(d, n);
  float again = sphere(p, r, centre(0));
  return 0.92 * (again > 0.0 ? onGrey(p + r * again) : beyond(p, r));
}

vec3 set() {
  vec3 from = vec3(0.0, 1.35, 0.0) - onForward * 4.2;
  vec3 ahead = normalize(vec3(0.0, 0.5, 0.0) - from), above = cross(onRight, ahead);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; i++) {
    vec2 shift = vec2(i & 1, i >> 1) * 0.5 - 0.25;
    vec2 at = place + shift * vec2(dFdx(place.x), dFdy(place.y));
    vec2 p = vec2(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y) * halfAngle;
    sum += shown(traced(from, normalize(ahead + p.x * onRight + p.y * above)));
  }
  return sum / 4.0;
}
`;

const MAIN = `
vec3 face(vec2 at, out bool isShown) {
  vec2 cell = floor(at), p = 2.0 * fract(at) - 1.0;
  isShown = true;
  if (cell == vec2(1, 0)) return vec3(p.x, 1.0, p.y);
  if (cell == vec2(0, 1)) return vec3(-1.0, -p.y, p.x);
  if (cell == vec2(1, 1)) return vec3(p.x, -p.y, 1.0);
  if (cell == vec2(2, 1)) return vec3(1.0, -p.y, -p.x);
  if (cell == vec2(3, 1)) return vec3(-p.x, -p.y, -1.0);
  if (cell == vec2(1, 2)) return vec3(p.x, -1.0, -p.y);
  isShown = false;
  return vec3(0.0, 1.0, 0.0);
}

void main() {
  vec3 d = vec3(0.0, 1.0, 0.0);
  bool isShown = true;
  float cover = 1.0;
  vec2 p = 2.0 * place - 1.0;
  if (view == ${VIEWS.set}) {
    colour = vec4(set(), 1.0);
    return;
  }
  if (view == ${VIEWS.planet}) {
    colour = vec4(shown(textureLod(sky, place, 0.0).rgb), 1.0);
    return;
  }
  if (view == ${VIEWS.equirect}) {
    vec2 turn = vec2(2.0 * PI, PI) * place;
    d = vec3(sin(turn.x) * sin(turn.y), cos(turn.y), -cos(turn.x) * sin(turn.y));
  }
  else if (view == ${VIEWS.look}) {
    d = normalize(forward + p.x * halfAngle.x * right - p.y * halfAngle.y * up);
  } else if (view == ${VIEWS.cross}) {
    d = normalize(face(place * vec2(4.0, 3.0), isShown));
  } else {
    float away = length(p) * PI / 2.0;
    cover = 1.0 - smoothstep(1.0 - 2.0 * pixel / PI, 1.0, length(p));
    vec2 level = normalize(p + vec2(1e-9, 0.0)) * sin(away);
    d = vec3(-level.x, cos(away), level.y);
  }
  colour = vec4(isShown ? cover * seen(d) : vec3(0.0), 1.0);
}`;

export const FRAGMENT = HEAD + SHOWN + BALLS + MAIN;
