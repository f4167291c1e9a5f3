(function () {
  "use strict";
  var box = document.getElementById("turntable");
  var canvas = document.getElementById("turntable-canvas");
  var gl = canvas.getContext("webgl");
  if (!gl || !gl.getExtension("OES_element_index_uint") || !gl.getExtension("OES_standard_derivatives")) { return; }
  var scene = JSON.parse(document.getElementById("turntable-scene").textContent);
  if (!scene.modes.length) { return; }
  box.hidden = false;
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
    "attribute vec3 point; attribute vec3 moved; uniform mat3 turn; uniform vec4 scale; uniform float near; uniform float shape;" +
    "varying vec3 seen; varying float size;" +
    "void main() { vec3 d = moved * scale.y; seen = turn * (point * scale.x + d * scale.z);" +
    "size = length(d) / scale.w; gl_Position = vec4(seen.x * near, seen.y * near * shape, -0.5 * seen.z, 1.0); }"));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER,
    "#extension GL_OES_standard_derivatives : enable\nprecision mediump float; varying vec3 seen; varying float size;" +
    "void main() { vec3 n = normalize(cross(dFdx(seen), dFdy(seen))); float light = 0.35 + 0.65 * abs(n.z);" +
    "vec3 low = vec3(0.27, 0.15, 0.45), mid = vec3(0.13, 0.57, 0.55), high = vec3(0.95, 0.86, 0.2);" +
    "vec3 c = size < 0.5 ? mix(low, mid, 2.0 * size) : mix(mid, high, 2.0 * size - 1.0);" +
    "gl_FragColor = vec4(c * light, 1.0); }"));
  gl.linkProgram(program);
  gl.useProgram(program);
  function place(name) { return gl.getUniformLocation(program, name); }
  var triangles = new Uint32Array(bytes(scene.triangles));
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
  function feed(buffer, name, values) {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    var at = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, 3, gl.SHORT, false, 0, 0);
  }
  feed(gl.createBuffer(), "point", new Int16Array(bytes(scene.points)));
  var shapes = gl.createBuffer(), mode = 0, largest = 1;
  function choose(k) {
    mode = k;
    var values = new Int16Array(bytes(scene.modes[k].shape));
    largest = 0;
    for (var i = 0; i < values.length; i += 3) {
      largest = Math.max(largest, Math.hypot(values[i], values[i + 1], values[i + 2]));
    }
    feed(shapes, "moved", values);
  }
  var list = document.getElementById("turntable-mode");
  scene.modes.forEach(function (item, k) { list.add(new Option(item.name, k)); });
  list.onchange = function () { choose(Number(list.value)); draw(0); };
  choose(0);
  var a = -0.85, b = 0.4, near = 1.7, moving = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  var button = document.getElementById("turntable-move");
  function said() { button.textContent = moving ? "Stop" : "Move"; button.setAttribute("aria-pressed", String(moving)); }
  button.onclick = function () { moving = !moving; said(); if (moving) { requestAnimationFrame(frame); } };
  var held = null;
  canvas.onpointerdown = function (e) { held = [e.clientX, e.clientY]; canvas.setPointerCapture(e.pointerId); };
  canvas.onpointerup = function () { held = null; };
  canvas.onpointermove = function (e) {
    if (!held) { return; }
    a += 0.008 * (e.clientX - held[0]);
    b = Math.max(-1.5, Math.min(1.5, b + 0.008 * (e.clientY - held[1])));
    held = [e.clientX, e.clientY];
    draw(0);
  };
  canvas.onwheel = function (e) { e.preventDefault(); near *= Math.exp(-0.001 * e.deltaY); draw(0); };
  gl.enable(gl.DEPTH_TEST);
  function draw(time) {
    var w = canvas.width = canvas.clientWidth, h = canvas.height = canvas.clientHeight;
    gl.viewport(0, 0, w, h);
    gl.clearColor(1, 1, 1, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    var ca = Math.cos(a), sa = Math.sin(a), cb = Math.cos(b), sb = Math.sin(b);
    gl.uniformMatrix3fv(place("turn"), false, [ca, sa * sb, -sa * cb, 0, cb, sb, sa, -ca * sb, ca * cb]);
    var scale = scene.modes[mode].scale;
    gl.uniform4f(place("scale"), scene.size, scale, time ? Math.cos(time / 300) : 1, largest * scale || 1);
    gl.uniform1f(place("near"), near);
    gl.uniform1f(place("shape"), w / h);
    gl.drawElements(gl.TRIANGLES, triangles.length, gl.UNSIGNED_INT, 0);
  }
  function frame(time) { draw(time); if (moving) { requestAnimationFrame(frame); } }
  said();
  if (moving) { requestAnimationFrame(frame); } else { draw(0); }
})();
