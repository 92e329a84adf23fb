// Draws the figures of the data block. All texts go in as text nodes.
(() => {
  "use strict";
  const page = JSON.parse(document.getElementById("data").textContent);
  document.title = "umov: " + page.title;
  document.getElementById("title").textContent = page.title;
  for (const note of page.notes) {
    const item = document.createElement("li");
    item.textContent = note;
    document.getElementById("notes").append(item);
  }
  // The sky overhead: zenith in the middle, north up, east left.
  const drawSky = (plot, figure) => {
    plot.style.height = "640px";
    const tracks = figure.lines.map((line) => ({
      type: "scatterpolar", mode: line.labels.some((label) => label) ? "lines+text" : "lines", name: line.name,
      theta: line.x, r: line.y.map((altitude) => altitude === null ? null : 90 - altitude), text: line.labels,
      textposition: line.x.map((azimuth) => azimuth % 360 > 180 ? "middle right" : "middle left"),
      textfont: { size: 11 }, cliponaxis: false, line: { color: line.colour, dash: line.dash, width: 3 },
      hovertemplate: "azimuth %{theta:.1f}°, zenith distance %{r:.1f}°<extra>" + line.name.replaceAll("<", "&lt;") + "</extra>",
    }));
    Plotly.newPlot(plot, tracks, {
      autosize: true, margin: { l: 50, r: 50, t: 30, b: 40 + 17 * Math.ceil(tracks.length / 3) },
      polar: {
        radialaxis: { range: [0, 90], tickvals: [0, 30, 60, 90], ticktext: ["90°", "60°", "30°", ""], angle: 45, tickangle: 0, gridcolor: "#e6e9ee" },
        angularaxis: { rotation: 90, direction: "counterclockwise", tickvals: [0, 45, 90, 135, 180, 225, 270, 315], ticktext: ["N", "NE", "E", "SE", "S", "SW", "W", "NW"], gridcolor: "#e6e9ee" },
      },
      legend: { orientation: "h", yref: "container", y: 0, yanchor: "bottom", font: { size: 11 } },
      font: { family: "system-ui, sans-serif", size: 13 },
    }, { responsive: true, displaylogo: false, toImageButtonOptions: { format: "svg", filename: figure.title } });
  };
  // All cards first: a plot takes the width that its card has once the grid is laid out.
  const plots = page.figures.map((figure) => {
    const card = document.createElement("section");
    card.className = "card";
    const heading = document.createElement("h2");
    heading.textContent = figure.title;
    const plot = document.createElement("div");
    plot.className = "plot";
    card.append(heading, plot);
    document.getElementById("figures").append(card);
    return plot;
  });
  page.figures.forEach((figure, index) => {
    const plot = plots[index];
    if (figure.sky) {
      drawSky(plot, figure);
      return;
    }
    const lines = figure.lines.map((line) => ({
      type: "scatter", mode: "lines", name: line.name, x: line.x, y: line.y,
      line: { color: line.colour, dash: line.dash, width: 2 },
    }));
    const axis = (title, more) => Object.assign({
      title: { text: title }, gridcolor: "#e6e9ee", zerolinecolor: "#b8bfc9", automargin: true,
    }, more);
    Plotly.newPlot(plot, lines, {
      autosize: true,
      margin: { l: 60, r: 12, t: 10, b: 60 + 17 * Math.ceil(lines.length / 3) },
      xaxis: axis(figure.x, {}),
      yaxis: axis(figure.y, { type: figure.log ? "log" : "linear", exponentformat: "power" }),
      legend: { orientation: "h", yref: "container", y: 0, yanchor: "bottom", font: { size: 11 } },
      font: { family: "system-ui, sans-serif", size: 13 },
    }, { responsive: true, displaylogo: false,
         toImageButtonOptions: { format: "svg", filename: figure.title } });
    // The width of a card changes with scroll bars and columns, not with the window alone.
    let width = 0;
    new ResizeObserver(() => {
      if (plot.clientWidth === width || !plot.layout) return;
      width = plot.clientWidth;
      Plotly.Plots.resize(plot);
    }).observe(plot);
  });
})();
