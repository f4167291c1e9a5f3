(function () {
  "use strict";
  var scene = JSON.parse(document.getElementById("turntable-scene").textContent);
  var box = document.getElementById("turntable");
  if (!scene.modes.length) { return; }
  box.hidden = false; // a canvas that is not shown has no size
  var table = turntable(document.getElementById("turntable-canvas"));
  if (!table) { box.hidden = true; return; }
  var moving = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  var list = document.getElementById("turntable-mode"), button = document.getElementById("turntable-move");
  function said() {
    button.textContent = moving ? "Stop" : "Move";
    button.setAttribute("aria-pressed", String(moving));
    table.run(moving);
  }
  scene.modes.forEach(function (item, k) { list.add(new Option(item.name, k)); });
  list.onchange = function () { table.move(scene.modes[Number(list.value)]); };
  button.onclick = function () { moving = !moving; said(); };
  table.show(scene);
  table.move(scene.modes[0]);
  said();
})();
