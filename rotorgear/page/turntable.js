// Solids of a gearbox that turn under the pointer and move in a mode: one module for the report and for the page of `rotorgear app`.
// Displacements go to the graphics card once; motion, colour and what stands under the pointer are found there.
function turntable(canvas, heard) {
  "use strict";
  heard = heard || {};
  var gl = canvas.getContext("webgl", {antialias: true});
  if (!gl || !gl.getExtension("OES_element_index_uint") || !gl.getExtension("OES_standard_derivatives")) { return null; }
  function bytes(text) {
    var raw = atob(text), out = new Uint8Array(raw.length);
    for (var k = 0; k < raw.length; k++) { out[k] = raw.charCodeAt(k); }
    return out.buffer;
  }
  function shader(kind, source) {
    var made = gl.createShader(kind);
    gl.shaderSource(made, source);
    gl.compileShader(made);
    return made;
  }
  var program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER,
    "attribute vec3 point; attribute vec3 moved; attribute vec3 late; attribute vec4 tint; attribute vec3 code;" +
    "uniform mat3 turn; uniform vec4 scale; uniform vec2 near; uniform vec2 phase; uniform float flat_code;" +
    "varying vec3 seen; varying float size; varying vec4 own;" +
    "void main() { seen = turn * (point * scale.x + (moved * phase.x - late * phase.y) * scale.y);" +
    "size = sqrt(dot(moved, moved) + dot(late, late)) / scale.w; own = flat_code > 0.5 ? vec4(code, 1.0) : tint;" +
    "gl_Position = vec4(seen.xy * near, -0.5 * seen.z, 1.0); }"));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER,
    "#extension GL_OES_standard_derivatives : enable\nprecision highp float; varying vec3 seen; varying float size; varying vec4 own;" +
    "uniform float by_size; uniform float alpha; uniform float flat_colour;" +
    "void main() { if (flat_colour > 0.5) { gl_FragColor = vec4(own.rgb, 1.0); return; }" +
    "vec3 n = normalize(cross(dFdx(seen), dFdy(seen))); float light = 0.4 + 0.6 * abs(n.z);" +
    "vec3 low = vec3(0.27, 0.15, 0.45), mid = vec3(0.13, 0.57, 0.55), high = vec3(0.95, 0.86, 0.2);" +
    "vec3 c = size < 0.5 ? mix(low, mid, 2.0 * size) : mix(mid, high, 2.0 * size - 1.0);" +
    "c = by_size > 0.5 ? c : own.rgb; c = own.a > 0.5 ? mix(c, vec3(0.95, 0.35, 0.05), 0.6) : c;" +
    "gl_FragColor = vec4(c * light * alpha, alpha); }"));
  gl.linkProgram(program);
  gl.useProgram(program);
  function place(name) { return gl.getUniformLocation(program, name); }
  var buffers = {};
  function feed(name, values, size, kind, whole) {
    buffers[name] = buffers[name] || gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    var at = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, kind, whole, 0, 0);
  }
  var corners = gl.createBuffer();
  var scene = null, owner = [], count = 0, mode = null, largest = 1, chosen = [], bySize = true, colours = [];
  var a = -0.85, b = 0.4, near = 1, fitted = false, moving = false, asked = false;

  function show(given) {
    scene = given;
    owner = new Uint16Array(bytes(scene.owner));
    var points = new Int16Array(bytes(scene.points)), triangles = new Uint32Array(bytes(scene.triangles));
    count = triangles.length;
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, corners);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
    feed("point", points, 3, gl.SHORT, false);
    var code = new Uint8Array(3 * owner.length);
    for (var i = 0; i < owner.length; i++) { code[3 * i] = (owner[i] + 1) & 255; code[3 * i + 1] = (owner[i] + 1) >> 8; }
    feed("code", code, 3, gl.UNSIGNED_BYTE, true);
    colours = scene.colours;
    if (!fitted) { fit(points); fitted = true; }
    move(null);
  }
  function fit(points) {
    size();
    var t = turned(), wide = 1e-9, high = 1e-9, s = scene.size;
    for (var i = 0; i < points.length; i += 3) {
      var x = points[i] * s, y = points[i + 1] * s, z = points[i + 2] * s;
      wide = Math.max(wide, Math.abs(t[0] * x + t[3] * y + t[6] * z));
      high = Math.max(high, Math.abs(t[1] * x + t[4] * y + t[7] * z));
    }
    near = 0.86 / Math.max(wide * across()[0], high * across()[1]);
  }
  function move(given) {
    mode = given;
    var still = new Int16Array(3 * owner.length);
    var moved = mode ? new Int16Array(bytes(mode.shape)) : still, late = mode && mode.late ? new Int16Array(bytes(mode.late)) : still;
    largest = 0;
    for (var i = 0; i < moved.length; i += 3) {
      largest = Math.max(largest, Math.hypot(moved[i], moved[i + 1], moved[i + 2], late[i], late[i + 1], late[i + 2]));
    }
    feed("moved", moved, 3, gl.SHORT, false);
    feed("late", late, 3, gl.SHORT, false);
    tint();
  }
  function tint() {
    var values = new Uint8Array(4 * owner.length);
    for (var i = 0; i < owner.length; i++) {
      var c = colours[owner[i]];
      values[4 * i] = c[0]; values[4 * i + 1] = c[1]; values[4 * i + 2] = c[2];
      values[4 * i + 3] = chosen[owner[i]] ? 255 : 0;
    }
    feed("tint", values, 4, gl.UNSIGNED_BYTE, true);
    wake();
  }
  // Without colours those of displacement; else one for each part, or for null those of its kind.
  function paint(given) {
    bySize = given === undefined;
    colours = given || (scene ? scene.colours : []);
    if (scene) { tint(); }
  }
  // Planets stand on every pin, and once in the file: all of a name are chosen.
  function choose(part) {
    chosen = scene ? scene.parts.map(function (name) { return name === part || name.split("#")[0] === part; }) : [];
    if (scene) { tint(); }
  }
  function run(on) { moving = on; wake(); }
  function size() {
    var dots = window.devicePixelRatio || 1;
    var w = Math.max(1, Math.round(canvas.clientWidth * dots)), h = Math.max(1, Math.round(canvas.clientHeight * dots));
    if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
  }
  function across() { var w = canvas.width, h = canvas.height; return [Math.min(1, h / w), Math.min(1, w / h)]; }
  function turned() {
    var ca = Math.cos(a), sa = Math.sin(a), cb = Math.cos(b), sb = Math.sin(b);
    return [ca, sa * sb, -sa * cb, 0, cb, sb, sa, -ca * sb, ca * cb];
  }
  function draw(time, codes) {
    if (!scene) { return; }
    size();
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(codes ? 0 : 1, codes ? 0 : 1, codes ? 0 : 1, 1);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.uniformMatrix3fv(place("turn"), false, turned());
    gl.uniform4f(place("scale"), scene.size, mode ? mode.scale : 0, 0, largest || 1);
    gl.uniform2f(place("near"), near * across()[0], near * across()[1]);
    var angle = time / 300;
    gl.uniform2f(place("phase"), time ? Math.cos(angle) : 1, time ? Math.sin(angle) : 0);
    gl.uniform1f(place("flat_code"), codes ? 1 : 0);
    gl.uniform1f(place("flat_colour"), codes ? 1 : 0);
    gl.uniform1f(place("by_size"), bySize && mode ? 1 : 0);
    gl.uniform1f(place("alpha"), 1);
    gl.drawElements(gl.TRIANGLES, scene.solid, gl.UNSIGNED_INT, 0);
    if (scene.solid === count || codes) { return; }
    // Casings last, as glass: what is behind them was drawn.
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    gl.uniform1f(place("alpha"), 0.09);
    gl.drawElements(gl.TRIANGLES, count - scene.solid, gl.UNSIGNED_INT, 4 * scene.solid);
    gl.disable(gl.BLEND);
  }
  function frame(time) {
    asked = false;
    draw(moving && mode ? time : 0, false);
    if (moving && mode) { wake(); }
  }
  function wake() { if (!asked) { asked = true; requestAnimationFrame(frame); } }
  function partAt(x, y) {
    draw(0, true);
    var dot = new Uint8Array(4), box = canvas.getBoundingClientRect();
    gl.readPixels(Math.round((x - box.left) * canvas.width / box.width), Math.round((box.bottom - y) * canvas.height / box.height),
      1, 1, gl.RGBA, gl.UNSIGNED_BYTE, dot);
    wake();
    var number = dot[0] + 256 * dot[1] - 1;
    return number < 0 ? "" : scene.parts[number];
  }
  var held = null, travelled = 0;
  canvas.onpointerdown = function (e) {
    held = [e.clientX, e.clientY];
    travelled = 0;
    canvas.setPointerCapture(e.pointerId);
  };
  canvas.onpointerup = function (e) {
    held = null;
    if (travelled < 4 && heard.pick && scene) { heard.pick(partAt(e.clientX, e.clientY)); }
  };
  canvas.onpointermove = function (e) {
    if (!held) { return; }
    travelled += Math.abs(e.clientX - held[0]) + Math.abs(e.clientY - held[1]);
    a += 0.008 * (e.clientX - held[0]);
    b = Math.max(-1.5, Math.min(1.5, b + 0.008 * (e.clientY - held[1])));
    held = [e.clientX, e.clientY];
    wake();
  };
  canvas.onwheel = function (e) { e.preventDefault(); near *= Math.exp(-0.001 * e.deltaY); wake(); };
  if (window.ResizeObserver) { new ResizeObserver(wake).observe(canvas); }
  return {show: show, move: move, paint: paint, choose: choose, run: run, partAt: partAt};
}
