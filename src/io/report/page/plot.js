// What all figures share: colours of the theme, axes, saving.

const isNarrow = () => window.innerWidth < 620;
const isTouch = window.matchMedia("(pointer: coarse)").matches;
const hasHover = window.matchMedia("(hover: hover)").matches; // else the tool bar would cover the legend

function themeColours() {
  const style = getComputedStyle(document.documentElement);
  const get = (name) => style.getPropertyValue(name).trim();
  return { card: get("--card"), text: get("--text"), soft: get("--soft"), grid: get("--grid"), line: get("--line") };
}

function axis(extra) {
  const theme = themeColours();
  return {
    gridcolor: theme.grid, zerolinecolor: theme.line, linecolor: theme.line, tickcolor: theme.line,
    ticks: "outside", ticklen: 4, automargin: true, ...extra,
    title: { standoff: 8, ...(typeof extra.title === "string" ? { text: extra.title } : extra.title) },
  };
}

function layout(extra) {
  const theme = themeColours();
  return {
    paper_bgcolor: theme.card, plot_bgcolor: theme.card,
    font: { family: "system-ui, DejaVu Sans, sans-serif", size: isNarrow() ? 11 : 12, color: theme.text },
    margin: { l: isNarrow() ? 44 : 60, r: isNarrow() ? 10 : 18, t: 8, b: 40 },
    legend: { orientation: "h", x: 0, xanchor: "left", y: 1.02, yanchor: "bottom", itemsizing: "constant" },
    hoverlabel: { font: { size: 12 } },
    // On a touch screen a drag scrolls the page.
    dragmode: isTouch ? false : "zoom",
    ...(paper.isPrinting ? { width: paper.width } : { autosize: true }),
    ...extra,
  };
}

/// A horizontal colour bar under the plot takes no width from it.
function colourBar(title, extra) {
  return {
    orientation: "h", x: 0.5, xanchor: "center", y: -0.1, yanchor: "top", thickness: 10, len: 0.9,
    outlinewidth: 0, title: { text: title, side: "top", font: { size: 12 } }, ...extra,
  };
}

const printedShare = 0.78; // of a figure's height on the screen
/// So many pixels below a plot whose figure is as high and leaves as much to margins and legend, in the plot's heights:
/// a bar keeps clear of the name of the axis above it, on paper too.
const below = (pixels, height, margins) => -pixels / ((paper.isPrinting ? printedShare : 1) * height - margins);

const isDarkPage = () => document.documentElement.dataset.theme === "dark";

/// From blue to yellow as Cividis (Nunez et al. 2018), which on dark pages begins with a blue that is seen there.
const phaseScale = () => isDarkPage()
  ? ["#5b7fd0", "#7d90b4", "#96978f", "#b4a976", "#d8c35f", "#ffe945"].map((c, i) => [i / 5, c]) : "Cividis";

// A cyclic map for angles that come back after 180 deg: twilight_shifted at 0, 1/12, ... 1
// (Bechtold 2018, CC0). Its dark end stands for 0, so that 0 is seen on a white page; on a dark one all are paler.
const twilightShifted = ["#301437", "#4e186f", "#5e45a6", "#6276ba", "#7ca2c2", "#b3c6ce", "#e2d9e2", "#d4bcac",
  "#c6896c", "#b25652", "#8d2b50", "#581647", "#2f1436"];
const paler = (hex) => "#" + [1, 3, 5].map((k) => Math.round(0.6 * parseInt(hex.slice(k, k + 2), 16) + 0.4 * 255).toString(16).padStart(2, "0")).join("");
const cyclicScale = () => twilightShifted.map((c, i) => [i / 12, isDarkPage() ? paler(c) : c]);

function download(name, text, type) {
  const link = document.createElement("a");
  const url = URL.createObjectURL(new Blob([text], { type }));
  link.href = url;
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

function element(tag, attributes, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (name === "onclick") node.addEventListener("click", value);
    else if (value !== null && value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

/// A row of buttons of which one is pressed.
function choice(name, options, current, onChange) {
  const box = element("span", { class: "choice", role: "group", "aria-label": name },
    element("span", { class: "name" }, name));
  for (const [value, label] of options) {
    const button = element("button", { type: "button", "aria-pressed": String(value === current) }, label);
    button.addEventListener("click", () => {
      for (const other of box.querySelectorAll("button")) other.setAttribute("aria-pressed", "false");
      button.setAttribute("aria-pressed", "true");
      onChange(value);
    });
    box.append(button);
  }
  return box;
}

const fileStem = (report.object || "object").replace(/[^A-Za-z0-9_-]+/g, "_") + "_";

const paper = { isPrinting: false, width: 650 }; // two figures stand on a sheet, A4 or Letter, inside its margins

/// One cursor through all figures against time and the pictures: where the pointer is in one of them, a line stands
/// in the others, and the picture nearest in time is framed.
const cursor = {
  cards: new Set(),
  follow(card) {
    if (!card.figure.isAgainstTime || this.cards.has(card)) return;
    this.cards.add(card);
    card.line = element("div", { class: "cursor", hidden: "" });
    card.plot.append(card.line);
    card.plot.on("plotly_hover", (event) => this.show(String(event.points[0].x), card));
    card.plot.on("plotly_unhover", () => this.hide());
  },
  show(time, source) {
    for (const card of this.cards) if (card !== source) this.place(card, time);
    const at = Date.parse(time.replace(" ", "T") + "Z");
    if (source) film.follow(at);
    const frames = [...document.querySelectorAll(".frame")];
    const off = frames.map((frame) => Math.abs(milliseconds(frame.dataset.time) - at));
    const nearest = off.length ? off.indexOf(Math.min(...off)) : -1;
    frames.forEach((frame, k) => frame.classList.toggle("near", k === nearest && off[k] < 120000));
  },
  /// The line of a card at a time, in the panel that has it.
  place(card, time) {
    const full = card.plot._fullLayout; // where Plotly keeps the places of its axes
    const panel = Object.keys(full || {}).filter((key) => /^xaxis[0-9]*$/.test(key)).map((key) => full[key])
      .find((one) => one.range && time >= String(one.range[0]) && time <= String(one.range[1]));
    card.line.hidden = !panel;
    if (!panel) return;
    card.line.style.left = (panel._offset + panel.d2p(time)).toFixed(1) + "px";
    card.line.style.top = full._size.t + "px";
    card.line.style.height = full._size.h + "px";
  },
  hide() {
    for (const card of this.cards) card.line.hidden = true;
    for (const frame of document.querySelectorAll(".frame.near")) frame.classList.remove("near");
  },
};

/// A figure on its card: `figure` has id, title, caption, height, controls, build(state), table(state).
class FigureCard {
  constructor(figure, parent) {
    this.figure = figure;
    this.state = Object.fromEntries((figure.controls || []).map((c) => [c.key, c.options[0][0]]));
    this.plot = element("div", { class: "plot", id: figure.id });
    const save = (format) => this.saveAs(format);
    this.save = element("span", { class: "save" },
      element("button", { type: "button", title: "Save as SVG", onclick: () => save("svg") }, "SVG"),
      element("button", { type: "button", title: "Save as PNG", onclick: () => save("png") }, "PNG"),
      element("button", { type: "button", title: "Save the numbers as CSV",
        onclick: () => download(fileStem + figure.id + ".csv", csvText(figure.table(this.state)), "text/csv") }, "CSV"));
    const controls = (figure.controls || []).filter((c) => c.options.length > 1).map((control) =>
      choice(control.name, control.options, this.state[control.key], (value) => {
        this.state[control.key] = value;
        this.draw();
      }));
    parent.append(element("section", { class: "card" },
      element("div", { class: "head" }, element("h2", {}, figure.title), this.save),
      controls.length ? element("div", { class: "controls" }, ...controls) : null,
      this.plot,
      element("p", { class: "caption" }, figure.caption)));
    // The width of a card changes with scroll bars and columns, not with the window alone.
    this.width = 0;
    new ResizeObserver(() => {
      if (this.plot.clientWidth === this.width || !this.plot.layout) return;
      this.width = this.plot.clientWidth;
      Plotly.Plots.resize(this.plot);
    }).observe(this.plot);
  }

  /// Light, whatever the page is, with its title, and named by what it shows.
  async saveAs(format) {
    const root = document.documentElement, theme = root.dataset.theme;
    try {
      root.dataset.theme = "light";
      const { data, layout: plan } = this.figure.build(this.state);
      root.dataset.theme = theme;
      const pass = selection.pass === "all" || passes.length < 2 ? "" : ", " + passes[Number(selection.pass)].label + " UTC";
      const title = { text: plain((report.object || "object") + pass + ": " + this.figure.title.toLowerCase()), x: 0.02, xanchor: "left", y: 0.97, yanchor: "top", font: { size: 15 } };
      const margin = { ...plan.margin, t: 92 };
      const shown = this.state.scale || this.state.band !== undefined && this.state.band !== "all" ? this.state.scale || bands[this.state.band].label : "";
      await Plotly.downloadImage({ data, layout: { ...plan, title, margin } }, { format, width: 1000, height: 640, scale: format === "png" ? 2 : 1,
        filename: fileStem + this.figure.id + (shown ? "_" + shown.replace(/[^A-Za-z0-9]+/g, "_") : "") });
    } catch {
      // a second press while the first is at work
    } finally {
      root.dataset.theme = theme;
    }
  }

  draw() {
    try {
      const { data, layout: plan } = this.figure.build(this.state);
      const height = typeof this.figure.height === "function" ? this.figure.height() : this.figure.height || 380;
      Plotly.react(this.plot, data, { ...plan, height: paper.isPrinting ? printedShare * height : height },
        { displaylogo: false, displayModeBar: hasHover ? "hover" : false, modeBarButtonsToRemove: ["select2d", "lasso2d", "toImage"] });
      cursor.follow(this);
    } catch (error) {
      Plotly.purge(this.plot);
      this.plot.replaceChildren(element("div", { class: "note" },
        "This figure could not be drawn: " + error.message + " The numbers are still saved with CSV."));
    }
  }
}
