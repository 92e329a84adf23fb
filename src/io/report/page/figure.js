// Draws one figure of lines and points: umovFigure(element, figure). Shared by the pages of plots.
const umovFigure = (() => {
  "use strict";
  // Pages follow the reader's choice of light or dark; paper is white.
  const isDark = window.matchMedia("(prefers-color-scheme: dark)");
  let isPrinting = false;
  const theme = () => isDark.matches && !isPrinting
    ? { card: "#1a1f28", text: "#e5e9f0", grid: "#303846", line: "#566072" } : { card: "#ffffff", text: "#1b1f24", grid: "#e6e9ee", line: "#b8bfc9" };
  const font = () => ({ family: "system-ui, sans-serif", size: 13, color: theme().text });
  const ground = () => ({ paper_bgcolor: theme().card, plot_bgcolor: theme().card, font: font() });
  const grid = () => ({ gridcolor: theme().grid, zerolinecolor: theme().line, tickcolor: theme().line });
  const options = (figure) => ({
    responsive: true, displaylogo: false, displayModeBar: window.matchMedia("(hover: hover)").matches ? "hover" : false, toImageButtonOptions: { format: "svg", filename: figure.title },
  });
  const legend = () => ({ orientation: "h", yref: "container", y: 0, yanchor: "bottom", font: { size: 11 } });
  const symbols = ["circle", "square", "diamond", "cross", "triangle-up", "x"];
  // Plotly takes some HTML in names: they are shown as they stand.
  // Bands are spelt for people, but for what is to be typed, which stands in quotes or after "=".
  const words = (text) => text.replace(/(?<!["'=\w])nm:(\d+(?:\.\d+)?)/g, "$1 nm");
  const safe = (text) => words(text).replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  // Thousands of bars hide each other and their points, unless they are paler and the points smaller.
  const paleness = (line) => line.faint ? Math.max(0.05, Math.min(0.35, 150 / line.x.length)) : 1;
  const dot = (most) => most < 60 ? 8 : most < 2000 ? 4 : 2.5;
  // The sky overhead: zenith in the middle, north up, east left.
  const drawSky = (plot, figure) => {
    plot.style.height = "640px";
    const tracks = figure.lines.map((line) => ({
      type: "scatterpolar", mode: line.labels.some((label) => label) ? "lines+text" : "lines", name: safe(line.name),
      theta: line.x, r: line.y.map((altitude) => altitude === null ? null : 90 - altitude), text: line.labels,
      textposition: line.x.map((azimuth) => azimuth % 360 > 180 ? "middle right" : "middle left"),
      textfont: { size: 11 }, cliponaxis: false, line: { color: line.colour, dash: line.dash, width: 3 },
      hovertemplate: "azimuth %{theta:.1f}°, zenith distance %{r:.1f}°<extra>" + safe(line.name) + "</extra>",
    }));
    Plotly.newPlot(plot, tracks, {
      autosize: true, margin: { l: 50, r: 50, t: 30, b: 40 + 17 * Math.ceil(tracks.length / 3) },
      polar: {
        bgcolor: theme().card,
        radialaxis: { range: [0, 90], tickvals: [0, 30, 60, 90], ticktext: ["90°", "60°", "30°", ""], angle: 45, tickangle: 0, ...grid() },
        angularaxis: { rotation: 90, direction: "counterclockwise", tickvals: [0, 45, 90, 135, 180, 225, 270, 315], ticktext: ["N", "NE", "E", "SE", "S", "SW", "W", "NW"], ...grid() },
      },
      legend: legend(), ...ground(),
    }, options(figure));
  };
  // In space: turned with the mouse.
  const drawSpace = (plot, figure) => {
    plot.style.height = "560px";
    const clouds = figure.lines.map((line, index) => ({
      type: "scatter3d", mode: line.markers ? "markers" : "lines", name: safe(line.name), x: line.x, y: line.y, z: line.z,
      marker: { size: line.markers ? 2.6 : 0, color: line.colour, symbol: symbols[index % 4] },
      line: { color: line.colour, width: 4, dash: line.dash },
    }));
    const axis = (title) => Object.assign({ title: { text: title } }, grid());
    Plotly.newPlot(plot, clouds, {
      autosize: true, margin: { l: 0, r: 0, t: 0, b: 20 + 17 * Math.ceil(clouds.length / 3) },
      scene: { xaxis: axis(figure.x), yaxis: axis(figure.y), zaxis: axis(figure.z), aspectmode: "cube",
               camera: { eye: { x: 1.6, y: -1.6, z: 0.9 } } },
      legend: legend(), ...ground(),
    }, options(figure));
  };
  // Marks of a logarithmic axis are numbers that stand by themselves ("20", not a small 2 beside 10): of 1, 2 and 5 of
  // each decade, or of powers of ten alone where it goes over more than two decades.
  const decades = (figure, along) => {
    const values = (figure[along + "span"] || figure.lines.flatMap((line) => line[along])).filter((value) => value > 0).map(Math.log10);
    const low = values.reduce((a, b) => Math.min(a, b), Infinity), high = values.reduce((a, b) => Math.max(a, b), -Infinity);
    return { tickformat: "~g", ...(high - low > 2 ? { dtick: Math.max(1, Math.round((high - low) / 6)) } : high - low > 0.7 ? { dtick: "D2" } : {}) };
  };
  const drawPlane = (plot, figure) => {
    const most = Math.max(...figure.lines.map((line) => line.faint || !line.markers ? 0 : line.x.length));
    // Marks follow the points alone: the same band has the same one in each figure, whatever bars and lines stand between.
    let marked = 0;
    const lines = figure.lines.map((line) => ({
      type: line.x.length > 2000 ? "scattergl" : "scatter", mode: line.markers ? "markers" : "lines",
      name: safe(line.name), x: line.x, y: line.y, opacity: paleness(line), showlegend: line.name !== "" && !figure.ynames && paleness(line) > 0.1,
      line: { color: line.colour, dash: line.dash, width: line.faint ? 1 : 2 },
      marker: { color: line.colour, size: dot(most), symbol: symbols[(line.markers ? marked++ : 0) % symbols.length] },
    }));
    // Points too small for a legend are shown larger there, by marks of no point: larger signs as such would cost lines their dashes.
    const legendMarks = lines.filter((line) => line.showlegend && line.mode === "markers").map((line) => {
      line.showlegend = false;
      line.legendgroup = line.name;
      return { type: "scatter", mode: "markers", name: line.name, legendgroup: line.name, x: [null], y: [null], hoverinfo: "skip", marker: { ...line.marker, size: 8 } };
    });
    const isSmall = plot.clientWidth < 460; // where a title that ends in a time takes two lines
    const axis = (title, more) => Object.assign({ title: { text: isSmall ? safe(title).replace(/ (since|after) (?=\d)/, " $1<br>") : safe(title), font: { size: isSmall ? 11 : 13 } }, automargin: true, ticks: "outside", ticklen: 4, exponentformat: "power", minexponent: 5, separatethousands: true }, grid(), more);
    Plotly.newPlot(plot, [...lines, ...legendMarks], {
      autosize: true,
      margin: { l: 60, r: 12, t: 10, b: 60 + (figure.ynames ? 0 : 17 * Math.ceil(lines.length / 3)) },
      xaxis: axis(figure.x, { ...(figure.xlog ? { type: "log", ...decades(figure, "x") } : {}), ...(figure.xspan ? { range: figure.xspan } : {}) }),
      yaxis: axis(figure.y, { type: figure.log ? "log" : "linear", ...(figure.ynames ? { tickvals: figure.ynames.map((_, k) => k + 1), ticktext: figure.ynames.map(safe) } : {}), ...(figure.log ? { nticks: 6, ...decades(figure, "y") } : {}), ...(figure.yspan ? { range: figure.log ? figure.yspan.map(Math.log10) : figure.yspan } : {}) }),
      legend: legend(), ...ground(),
    }, options(figure));
    if (plot.isWatched) return;
    plot.isWatched = true;
    // The width of a card changes with scroll bars and columns, not with the window alone.
    let width = 0;
    new ResizeObserver(() => {
      if (plot.clientWidth === width || !plot.layout) return;
      width = plot.clientWidth;
      Plotly.Plots.resize(plot);
    }).observe(plot);
  };
  const draw = (plot, figure) => (figure.sky ? drawSky : figure.z ? drawSpace : drawPlane)(plot, figure);
  const drawn = [];
  const drawAll = () => drawn.forEach(([plot, figure]) => draw(plot, figure));
  isDark.addEventListener("change", drawAll);
  // Paper has a width of its own, and who observes sizes does not hear of it; two figures and a title fit on a sheet.
  const paper = { width: 640, height: 370 }, fitted = new Set();
  const fitPaper = () => drawn.forEach(([plot]) => {
    if (!plot.layout) return;
    fitted.add(plot);
    Plotly.relayout(plot, plot.style.height ? { width: paper.width } : paper);
  });
  const fitWindow = () => {
    for (const plot of fitted) Plotly.relayout(plot, { width: null, height: null, autosize: true });
    fitted.clear();
  };
  for (const [event, value] of [["beforeprint", true], ["afterprint", false]])
    window.addEventListener(event, () => {
      if (isDark.matches) {
        isPrinting = value;
        drawAll();
      }
      (value ? fitPaper : fitWindow)();
    });
  const show = (plot, figure) => {
    drawn.push([plot, figure]);
    draw(plot, figure);
  };
  return Object.assign(show, { words });
})();
