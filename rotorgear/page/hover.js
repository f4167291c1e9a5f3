// Says what the point of a picture under the pointer is: [x, y, words] in shares of the picture's width and height.
function hover(box, points) {
  "use strict";
  var said = document.createElement("div"), dot = document.createElement("div");
  said.className = "said"; dot.className = "dot";
  said.hidden = dot.hidden = true;
  box.append(dot, said);
  box.onpointermove = function (e) {
    var frame = box.firstElementChild.getBoundingClientRect();
    var x = e.clientX - frame.left, y = e.clientY - frame.top, best = null, least = 24 * 24;
    points.forEach(function (point) {
      var dx = point[0] * frame.width - x, dy = point[1] * frame.height - y;
      if (dx * dx + dy * dy < least) { least = dx * dx + dy * dy; best = point; }
    });
    said.hidden = dot.hidden = !best;
    if (!best) { return; }
    said.textContent = best[2];
    dot.style.left = 100 * best[0] + "%"; dot.style.top = 100 * best[1] + "%";
    said.style.top = dot.style.top;
    said.style.left = best[0] < 0.6 ? dot.style.left : ""; said.style.right = best[0] < 0.6 ? "" : 100 * (1 - best[0]) + "%";
  };
  box.onpointerleave = function () { said.hidden = dot.hidden = true; };
}
