// Boxes of text: summary, warnings, conventions, manifest, key frames. All texts go in as text nodes.

const byId = (id) => document.getElementById(id);

function fact(name, value) {
  return element("div", {}, element("dt", {}, name), element("dd", {}, value));
}

function coordinates(site) {
  const north = Math.abs(site.lat).toFixed(4) + "° " + (site.lat < 0 ? "S" : "N");
  const east = Math.abs(site.lon).toFixed(4) + "° " + (site.lon < 0 ? "W" : "E");
  return (site.name ? site.name + " (" : "") + north + ", " + east + ", " + site.alt_m.toFixed(0) + " m" + (site.name ? ")" : "");
}

/// What the magnitudes of the summary are: of one band, since a range over several would mix the object's colour into it.
const magnitudeTitle = report.mag_system + " magnitude" + (bands.length ? ", " + bands[middleBand].label : "");

/// Magnitudes from bright to faint over some rows; limits count as ">".
function magnitudeText(rows) {
  const band = bands[middleBand] || { mag: [], mag_limit: [] };
  const known = range(rows.map((i) => band.mag_limit[i] ? null : band.mag[i]));
  const limits = range(rows.map((i) => band.mag_limit[i] ? band.mag[i] : null));
  if (!known) return limits ? "> " + limits[0].toFixed(2) : "no light";
  return known[0].toFixed(2) + " to " + (limits ? "> " + Math.max(known[1], limits[1]).toFixed(2) : known[1].toFixed(2));
}

/// When it is brightest, and at which phase; "" where no magnitude is known.
function brightestText() {
  let best = null;
  for (const band of bands.slice(middleBand, middleBand + 1))
    band.mag.forEach((mag, i) => {
      if (mag !== null && !band.mag_limit[i] && (best === null || mag < best.mag)) best = { mag, row: i };
    });
  return best ? " (brightest " + epochs.time[best.row].slice(11, 19) + ", phase " + epochs.phase[best.row].toFixed(1) + "°)" : "";
}

function greatestP(rows) {
  let best = null;
  for (const band of bands)
    for (const i of rows)
      if (band.p[i] !== null && (best === null || band.p[i] > best.p)) best = { p: band.p[i], band: band.label, row: i };
  return best;
}

function passTable() {
  const head = ["pass", "rise", "culmination", "set", "max altitude", "rows", magnitudeTitle, "max p"];
  const body = report.passes.map((pass) => {
    const own = passes.filter((p) => p.id === pass.id).flatMap((p) => p.rows);
    const p = greatestP(own);
    const cells = [pass.id, (pass.open_start ? "before " : "") + pass.rise.slice(0, 19).replace("T", " "), pass.culmination.slice(pass.culmination.slice(0, 10) === pass.rise.slice(0, 10) ? 11 : 0, 19).replace("T", " "),
      (pass.open_end ? "after " : "") + pass.set.slice(pass.set.slice(0, 10) === pass.rise.slice(0, 10) ? 11 : 0, 19).replace("T", " "), pass.altitude_max.toFixed(1) + "°", String(pass.rows),
      magnitudeText(own), p ? fixed(100 * p.p, 1) + "\u00a0%" : "undefined"];
    // A date is not broken at its hyphens.
    const words = (text) => text.split(" ").flatMap((word) => [element("span", { class: "whole" }, word), " "]);
    return element("tr", {}, ...cells.map((cell, k) => element("td", { "data-label": head[k] }, ...(k ? words(cell) : [cell]))));
  });
  return element("table", { class: "passes" },
    element("thead", {}, element("tr", {}, ...head.map((name) => element("th", { scope: "col" }, name)))),
    element("tbody", {}, ...body));
}

function fillSummary() {
  const all = epochs.time.map((_, i) => i);
  const phase = range(epochs.phase), altitude = range(epochs.alt), p = greatestP(all);
  const dark = epochs.dark.reduce((a, b) => a + b, 0);
  const facts = element("dl", { class: "facts" },
    fact("Object", report.object || "not named"),
    fact("NORAD catalogue number", report.norad_cat_id ? String(report.norad_cat_id) : "none"),
    fact("Site", coordinates(report.site)),
    fact("Passes", String(report.passes.length || passes.length)),
    fact("Epochs", epochCount + (dark ? ", " + dark + " dark" : "")),
    fact("Bands", bands.map((band) => band.label).join(", ") || "none"),
    fact("Maximum altitude", altitude ? altitude[1].toFixed(1) + "°" : "none"),
    fact("Phase angle", phase ? phase[0].toFixed(1) + "° to " + phase[1].toFixed(1) + "°" : "none"),
    fact(magnitudeTitle, magnitudeText(all) + brightestText()),
    fact("Maximum p", p ? (100 * p.p).toFixed(1) + " % (" + p.band + ", phase " + epochs.phase[p.row].toFixed(1) + "°)" : "undefined"));
  byId("summary").append(facts, report.passes.length ? passTable() : "");
  const span = epochCount ? epochs.time[0].slice(0, 19) + "Z to " + epochs.time[epochCount - 1].slice(0, 19) + "Z" : "no epochs";
  byId("subtitle").textContent = "Polarized light curve, " + span.replace(/T/g, " ");
}

function fillWarnings() {
  const texts = [...report.warnings];
  if (report.stride > 1)
    texts.push("The curve is long: this page shows every " + report.stride + "th epoch; the tables hold all of them.");
  if (!texts.length) return;
  byId("warnings").hidden = false;
  byId("warnings").append(element("h2", {}, texts.length === 1 ? "Warning" : texts.length + " warnings"),
    element("ul", {}, ...texts.map((text) => element("li", {}, text))));
}

function fillBoxes() {
  byId("conventions").append(element("h2", {}, "Conventions"),
    element("ul", {}, ...report.conventions.map((text) => element("li", {}, text))));
  const rows = report.manifest.map(([key, value]) => element("tr", {}, element("th", { scope: "row" }, key), element("td", {}, value)));
  byId("manifest").append(element("h2", {}, "Manifest"), rows.length
    ? element("table", { class: "manifest" }, element("tbody", {}, ...rows)) : element("p", { class: "caption" }, "none given"));
}

const svgNamespace = "http://www.w3.org/2000/svg"; // the name of SVG, nothing is loaded from it
function svg(tag, attributes, text) {
  const node = document.createElementNS(svgNamespace, tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  if (text) node.textContent = text;
  return node;
}

/// Compass and the side of the Sun, drawn over a picture.
function overlay(frame) {
  const picture = svg("svg", { viewBox: "0 0 100 100", "aria-hidden": "true" });
  const mark = { fill: "#cfd6e4", "font-size": "6", "font-family": "sans-serif", "text-anchor": "middle", stroke: "#0a0c12", "stroke-width": "2.4", "paint-order": "stroke" };
  picture.append(svg("path", { d: "M91 93 V82 M91 93 H80", stroke: "#cfd6e4", "stroke-width": "0.7", fill: "none" }),
    svg("text", { x: 91, y: 80, ...mark }, "N"), svg("text", { x: 77, y: 95, ...mark }, "E"));
  const [right, up] = frame.sun;
  const length = Math.hypot(right, up);
  if (length > 0.02) {
    const x = right / length, y = -up / length;
    const at = (r, side) => (50 + r * x - side * y).toFixed(2) + " " + (50 + r * y + side * x).toFixed(2);
    const middle = 41.5 - 6.5 * Math.abs(x) - 3.5 * Math.abs(y); // the word ends where the arrow begins
    picture.append(svg("text", { ...mark, fill: "#f0c040", x: 50 + middle * x, y: 52 + middle * y }, "Sun"),
      svg("path", { d: "M" + at(48, 0) + " L" + at(43, 2.6) + " L" + at(43, -2.6) + " Z", fill: "#f0c040", stroke: "#0a0c12", "stroke-width": "0.6" }));
  }
  return picture;
}

function frameLegend() {
  const ramp = "linear-gradient(to right, " + report.polarization_scale.join(", ") + ")";
  const names = report.contributions.map((part) => element("span", {},
    element("span", { class: "swatch", style: "background:" + part.colour }), part.material));
  return element("div", { class: "legend" },
    element("span", {}, element("span", { class: "swatch", style: "background:#3a4664" }), "seen, but no light"),
    element("span", {}, "p: 0 %", element("span", { class: "ramp", style: "background:" + ramp }), "100 %"), ...names);
}

/// How much fainter than the brightest picture one may be before it is as white.
function exposureText(frame) {
  const longest = Math.max(...report.key_frames.map((one) => one.white));
  if (report.key_frames.length < 2 || !(frame.white > 0)) return "";
  const times = longest / frame.white;
  return times < 1.05 ? " · exposed shortest of all" : " · exposed " + (times < 10 ? times.toFixed(1) : Number(times.toPrecision(2)).toLocaleString("en")) + " times as long";
}

/// The object through a pass: drawn at the time of the cursor, or played.
const film = {
  frames: report.film.map((frame) => ({ ...frame, clock: milliseconds(frame.time) })),
  at: 0,
  timer: 0,
  fill(parent) {
    if (!this.frames.length) return;
    this.image = element("img", { alt: "The object as it turns", width: 200, height: 200 });
    this.slider = element("input", { type: "range", min: 0, max: this.frames.length - 1, value: 0, "aria-label": "Time" });
    this.label = element("b", {});
    this.button = element("button", { type: "button", class: "plain", onclick: () => this.play(!this.timer) }, "Play");
    this.slider.addEventListener("input", () => { this.play(false); this.to(Number(this.slider.value), true); });
    parent.append(element("figure", { class: "film" }, this.image,
      element("div", {}, this.label, this.slider, this.button,
        element("p", { class: "caption" }, "The object through its longest lit pass, one exposure for all pictures (asinh). It follows the cursor in the figures against time."))));
    this.to(0);
  },
  to(k, isByHand) {
    this.at = k;
    this.image.src = this.frames[k].src;
    this.label.textContent = this.frames[k].time.slice(0, 19).replace("T", " ");
    this.slider.value = k;
    if (isByHand) cursor.show(plotTime(this.frames[k].time), null);
  },
  /// The picture nearest to a time of its pass.
  follow(clockTime) {
    if (!this.frames.length || this.timer || clockTime < this.frames[0].clock - 60000 || clockTime > this.frames[this.frames.length - 1].clock + 60000) return;
    const off = this.frames.map((frame) => Math.abs(frame.clock - clockTime));
    const nearest = off.indexOf(Math.min(...off));
    if (nearest !== this.at) this.to(nearest);
  },
  play(isOn) {
    clearInterval(this.timer);
    this.timer = isOn ? setInterval(() => this.to((this.at + 1) % this.frames.length, true), 200) : 0;
    this.button.textContent = isOn ? "Pause" : "Play";
    if (!isOn) cursor.hide();
  },
};

function fillKeyFrames() {
  if (!report.key_frames.length) return;
  const frames = report.key_frames.map((frame, k) => element("figure", { class: "frame", "data-time": frame.time },
    element("div", { class: "pictures" }, ...frame.pictures.map((picture) => element("a",
      { class: "picture", href: picture.src, download: fileStem + "frame" + (k + 1) + "_" + picture.label + ".png", title: "Save this picture" },
      element("img", { src: picture.src, alt: "Object at " + frame.time + ", " + picture.label }), overlay(frame),
      element("span", {}, picture.label)))),
    element("figcaption", {}, element("b", {}, frame.time.slice(0, 19).replace("T", " ")), " · " + frame.caption + " · " + frame.width_m.toFixed(1) + " m wide" + exposureText(frame))));
  byId("frames").hidden = false;
  byId("frames").append(element("h2", {}, "The object as the observer sees it"), frameLegend(),
    element("p", { class: "caption" }, "Celestial north up, east left; each picture of brightness has its own exposure, told below it, on a logarithmic-like (asinh) scale; material darker in shadow. The arrow points to the side of the Sun."),
    element("div", { class: "frame-grid" }, ...frames));
  film.fill(byId("frames"));
}
