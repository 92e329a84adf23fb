// Puts the page together.

const cards = [];

function showFailure(text) {
  byId("failure").hidden = false;
  byId("failure").textContent = text;
}

function drawAll() {
  for (const card of cards) card.draw();
}

function fillSelection() {
  if (passes.length < 2) return;
  const options = passes.map((pass, k) => [String(k), pass.label + (pass.id ? "" : " (outside a pass)")]);
  // Panels of more than six passes side by side would be too small to read.
  if (passes.length <= 6) options.unshift(["all", "all"]);
  else selection.pass = "0";
  if (isNarrow() && passes.length > 2) selection.pass = "0";
  byId("selection").hidden = false;
  byId("selection").append(choice("Pass", options, selection.pass, (value) => {
    selection.pass = value;
    drawAll();
  }));
}

function setTheme(name) {
  document.documentElement.dataset.theme = name;
  byId("theme").textContent = name === "dark" ? "Light" : "Dark";
  byId("theme").setAttribute("aria-pressed", String(name === "dark"));
}

function fillFigures() {
  const figures = [timeFigures[0], turningFigure, brightnessPhaseFigure, phaseFigure, timeFigures[1], planeFigure, timeFigures[2], skyFigure,
    contributions.length ? contributionFigure : null, report.bounces > 1 ? indirectFigure : null, rgbBands.length ? rgbFigure : null, colourPairs.length ? colourFigure : null];
  for (const figure of figures.filter(Boolean)) cards.push(new FigureCard(figure, byId("figures")));
  drawAll();
}

if (window.matchMedia("(prefers-color-scheme: dark)").matches) setTheme("dark");
for (const fill of [fillSummary, fillWarnings, fillBoxes, fillKeyFrames])
  try {
    fill();
  } catch (error) {
    showFailure("A part of this page could not be shown: " + error.message);
  }
if (typeof Plotly === "undefined") showFailure("The plotting script did not start in this browser; the tables beside this page hold the numbers.");
else if (!epochCount || !bands.length) showFailure("There are no epochs to draw.");
else {
  fillSelection();
  fillFigures();
}

byId("theme").addEventListener("click", () => {
  setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark");
  drawAll();
});
let wasDark = false;
window.addEventListener("beforeprint", () => {
  wasDark = document.documentElement.dataset.theme === "dark";
  if (wasDark) setTheme("light");
  paper.isPrinting = true;
  drawAll();
});
window.addEventListener("afterprint", () => {
  if (wasDark) setTheme("dark");
  paper.isPrinting = false;
  drawAll();
});
let narrow = isNarrow();
window.addEventListener("resize", () => {
  if (narrow !== isNarrow()) {
    narrow = isNarrow();
    drawAll();
  }
});
