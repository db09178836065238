#include "core/printing/blink_page.h"

#include "core/printing/board_drawing.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace evical {
namespace {

// Template; code below replaces the @...@ marks.
constexpr std::string_view kPage = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>Evical: blinking board</title>
<style>
html, body { margin: 0; height: 100%; background: white; color: black; font: 16px/1.5 sans-serif; }
#setup { max-width: 46em; margin: 0 auto; padding: 1em; }
#bar { width: 600px; height: 16px; background: black; }
#stage { position: fixed; inset: 0; background: white; display: none; cursor: none; }
#stage svg { position: absolute; }
body.flashing #stage { display: block; }
body.flashing #setup { display: none; }
input { width: 6em; font: inherit; }
select, button { font: inherit; }
pre { background: #eee; padding: 0.7em; }
.warning { border-left: 4px solid #c60; padding-left: 0.7em; }
</style>
</head>
<body>
<div id="setup">
<h1>Blinking board</h1>
<p class="warning">This page flashes the whole screen. Flashing light can trigger seizures in people with
photosensitive epilepsy.</p>
<p>For the intrinsics of an event camera at rest. Set the browser's zoom to 100 % and the
screen to full brightness.</p>
<ol>
<li><p>Measure the length of this bar with a ruler:</p>
<div id="bar"></div>
<p><label>It is <input id="length" type="number" min="1" step="0.1"> mm long.</label></p></li>
<li><p><label>Flash at <select id="rate"></select></label> <span id="refresh"></span></p></li>
<li><p>In the session:</p>
<pre id="session"></pre></li>
<li><p><button id="start">Flash in full screen</button> Press Escape or click to stop.</p></li>
<li><p>Record a few seconds from each of at least 15 poses: the camera at rest, or almost at rest, the board in every
part of the image, near and far, tilted by 20 to 40 degrees to all four sides.</p></li>
</ol>
</div>
<div id="stage"><svg id="board" xmlns="http://www.w3.org/2000/svg" viewBox="0 0 @WIDTH@ @HEIGHT@"
shape-rendering="@RENDERING@"><g id="ink">
@ELEMENTS@</g></svg></div>
<script>
"use strict";
const board = @BOARD@;
const byId = (id) => document.getElementById(id);

// Largest layout that fits the screen, with a spacing of a whole number of device pixels. Sizes are in CSS
// pixels.
function layOut(width_px, height_px, ratio) {
  const largest = Math.min(width_px / board.width_mm, height_px / board.height_mm);
  const spacing_px = Math.max(1, Math.floor(largest * board.spacing_mm * ratio)) / ratio;
  return { spacing_px, px_per_mm: spacing_px / board.spacing_mm };
}

// Spacing in metres from the measured length of the bar; undefined until it was measured.
function trueSpacing_m(layout, bar_px, length_mm) {
  return length_mm > 0 ? layout.spacing_px * length_mm / bar_px / 1000 : undefined;
}

function sessionText(spacing_m) {
  const of = (part) => spacing_m === undefined ? "?" : (spacing_m * part).toFixed(6);
  let text = `board:\n  type: ${board.type}\n  rows: ${board.rows}\n  cols: ${board.cols}\n  spacing_m: ${of(1)}\n`;
  if (board.radius_mm > 0) text += `  radius_m: ${of(board.radius_mm / board.spacing_mm)}\n  circles: ${board.circles}\n`;
  if (board.tag_size_mm > 0) text += `  tag_size_m: ${of(board.tag_size_mm / board.spacing_mm)}\n`;
  return text + "  blinking: true\n";
}

let layout, frames_per_half = 1, flashing = false, frames = 0;

// Possible rates; the default is the fastest one up to 30 Hz.
function ratesOf(refresh_hz) {
  const rates = [];
  for (let frames = 1; refresh_hz / (2 * frames) >= 5; ++frames) rates.push({ frames, hz: refresh_hz / (2 * frames) });
  const chosen = rates.find((rate) => rate.hz <= 31) || rates[rates.length - 1];
  return { rates, chosen };
}

function show() {
  const bar_px = byId("bar").getBoundingClientRect().width;
  byId("session").textContent = sessionText(trueSpacing_m(layout, bar_px, parseFloat(byId("length").value)));
}

// Places the board in the current window and updates the session's text.
function place() {
  layout = layOut(window.innerWidth, window.innerHeight, window.devicePixelRatio || 1);
  show();
  const width = board.width_mm * layout.px_per_mm, height = board.height_mm * layout.px_per_mm;
  const svg = byId("board");
  svg.setAttribute("width", width);
  svg.setAttribute("height", height);
  svg.style.left = Math.floor((window.innerWidth - width) / 2) + "px";
  svg.style.top = Math.floor((window.innerHeight - height) / 2) + "px";
}

function tick() {
  if (!flashing) return;
  byId("ink").style.visibility = Math.floor(frames++ / frames_per_half) % 2 === 0 ? "visible" : "hidden";
  requestAnimationFrame(tick);
}

function start() {
  frames_per_half = parseInt(byId("rate").value, 10) || 1;
  document.body.classList.add("flashing");
  flashing = true;
  frames = 0;
  stayAwake();
  place();
  requestAnimationFrame(tick);
}

// Keeps the screen on, if the browser allows it.
function stayAwake() {
  if (navigator.wakeLock) navigator.wakeLock.request("screen").catch(() => {});
}

function stop() {
  flashing = false;
  document.body.classList.remove("flashing");
  if (document.fullscreenElement) document.exitFullscreen();
}

// Refresh rate from the median interval between 60 frames.
function measureRefresh(then) {
  const times = [];
  const next = (now) => {
    times.push(now);
    if (times.length < 60) return requestAnimationFrame(next);
    const steps = times.slice(1).map((time, k) => time - times[k]).sort((a, b) => a - b);
    then(1000 / steps[Math.floor(steps.length / 2)]);
  };
  requestAnimationFrame(next);
}

measureRefresh((refresh_hz) => {
  const { rates, chosen } = ratesOf(refresh_hz);
  for (const rate of rates) byId("rate").add(new Option(rate.hz.toFixed(1) + " Hz", rate.frames, false, rate === chosen));
  byId("refresh").textContent = `(the screen's refresh rate is ${refresh_hz.toFixed(0)} Hz)`;
});
byId("length").addEventListener("input", show);
byId("start").addEventListener("click", () => {
  const full = document.documentElement.requestFullscreen;
  if (full) full.call(document.documentElement).then(start, start); else start();
});
byId("stage").addEventListener("click", stop);
document.addEventListener("keydown", (event) => { if (event.key === "Escape") stop(); });
document.addEventListener("fullscreenchange", () => { if (document.fullscreenElement) place(); else stop(); });
window.addEventListener("resize", () => { if (flashing) place(); });
layout = layOut(screen.width, screen.height, window.devicePixelRatio || 1);
show();
</script>
</body>
</html>
)";

std::string boardObject(const Board& board, const BoardPicture& picture) {
  constexpr double kMmPerM = 1e3;
  return fmt::format(
      "{{type: \"{}\", rows: {}, cols: {}, spacing_mm: {}, radius_mm: {}, circles: \"{}\", tag_size_mm: {}, "
      "width_mm: {}, "
      "height_mm: {}}}",
      boardTypeName(board.type), board.rows, board.cols, kMmPerM * board.spacing_m, kMmPerM * board.radius_m,
      board.circles == CircleShade::Dark ? "dark" : "bright", kMmPerM * board.tag_size_m, picture.width_mm,
      picture.height_mm);
}

}  // namespace

std::string blinkPage(const Board& board, double margin_m, const TagPrint& print) {
  const BoardPicture picture = boardPicture(board, margin_m, print);
  std::string page(kPage);
  for (const auto& [name, text] :
       {std::pair{"@WIDTH@", fmt::format("{}", picture.width_mm)},
        {"@HEIGHT@", fmt::format("{}", picture.height_mm)},
        {"@RENDERING@", std::string(board.hasCircles() ? "geometricPrecision" : "crispEdges")},
        {"@ELEMENTS@", picture.elements},
        {"@BOARD@", boardObject(board, picture)}}) {
    const std::string place = name;
    page.replace(page.find(place), place.size(), text);
  }
  return page;
}

}  // namespace evical
