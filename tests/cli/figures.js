// What a page of ours shows once it is drawn; tests/cli/browser.py evaluates this in the page.
(async () => {
  const pause = (ms) => new Promise((done) => setTimeout(done, ms));
  const plots = () => [...document.querySelectorAll(".plot")];
  const isDrawn = (plot) => plot._fullData && (!plot._fullLayout.scene || plot._fullLayout.scene._scene);
  while (document.readyState !== "complete") await pause(20);
  // Figures follow one by one as the page finds time: a figure that never comes is found as not drawn.
  for (let waited = 0; waited < 200 && !plots().every((plot) => isDrawn(plot) || plot.querySelector(".note")); ++waited) await pause(50);
  await pause(300);

  const isNumber = (value) => Number.isFinite(value);
  /// How many points the axes of a trace show; `null` where the kind of trace has no such axes.
  const inside = (plot, trace, points) => {
    if (trace.type !== "scatter" && trace.type !== "scattergl") return null;
    const x = plot._fullLayout["xaxis" + trace.xaxis.slice(1)], y = plot._fullLayout["yaxis" + trace.yaxis.slice(1)];
    const isOn = (axis, value) => isNumber(value) && axis.c2p(value) > -1 && axis.c2p(value) < axis._length + 1;
    return points.filter((point) => isOn(x, point.x) && isOn(y, point.s === undefined || !trace.stackgroup ? point.y : point.s)).length;
  };
  const isPath = (path) => (path.getAttribute("d") || "").replace("M0,0Z", "").length > 3 && path.style.display !== "none";
  const traces = (plot) => plot._fullData.map((trace, k) => {
    const values = ["x", "theta"].map((key) => trace[key] || []).find((list) => list.length) || [];
    const group = plot.querySelector(".trace" + trace.uid);
    return {
      name: trace.name, type: trace.type, visible: trace.visible === true, values: [...values].filter((value) => value !== null).length,
      inside: inside(plot, trace, plot.calcdata[k] || []), paths: group ? [...group.querySelectorAll("path, text")].filter((one) => one.tagName === "text" || isPath(one)).length : 0,
    };
  });
  /// Titles of axes and bars that reach beyond their figure.
  const cutTitles = (plot) => [...plot.querySelectorAll(".xtitle, .ytitle, .cbtitle")].filter((title) => {
    const own = title.getBoundingClientRect(), all = plot.getBoundingClientRect();
    return own.left < all.left - 1 || own.right > all.right + 1 || own.top < all.top - 1 || own.bottom > all.bottom + 1;
  }).map((title) => title.textContent);
  /// Marks of one axis that say the same, such as 05:29 and 05:29.
  const marksTwice = (plot) => {
    const said = ["xtick", "x2tick", "x3tick", "ytick", "y2tick"].flatMap((axis) => [...plot.querySelectorAll("." + axis + " text")].map((mark) => axis + " " + mark.textContent));
    return said.filter((one, k) => said.indexOf(one) !== k);
  };
  const figures = plots().map((plot) => ({
    title: plot.parentElement.querySelector("h2, h4").textContent,
    note: plot.querySelector(".note") ? plot.querySelector(".note").textContent : "",
    traces: plot._fullData ? traces(plot) : [],
    canvases: plot.querySelectorAll("canvas").length,
    cut: cutTitles(plot), twice: marksTwice(plot),
    height: plot.getBoundingClientRect().height,
  }));
  const root = document.documentElement;
  const failure = document.getElementById("failure");
  return {
    figures, failure: failure && !failure.hidden ? failure.textContent : "",
    svg: [...document.querySelectorAll("svg#sky path, svg#sky circle, svg#sky polyline")].length,
    rows: document.querySelectorAll("tbody tr").length,
    sideways: root.scrollWidth - root.clientWidth,
    // What sticks out of the window, for the message.
    wide: [...document.querySelectorAll("body *")].filter((one) => one.getBoundingClientRect().right > root.clientWidth + 1 && !one.closest("svg"))
      .slice(0, 5).map((one) => one.tagName + "." + one.className),
  };
})();
