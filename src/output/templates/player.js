"use strict";
(() => {
  const motion = JSON.parse(document.getElementById("motion").textContent);
  const player = document.getElementById("player");
  const [canvas, button, slider, output] = ["canvas", "button", "input", "output"].map((q) => player.querySelector(q));
  const context = canvas.getContext("2d");
  const colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#3c3c3c"];
  const count = motion.frames.length, last = count - 1;
  const margin = 26;
  // A motion is shown at its own speed where a person can follow it, a load path in four seconds.
  const byTime = motion.name === "time" && motion.labels.length === 0;
  const duration = byTime ? Math.min(Math.max(motion.parameter[last] - motion.parameter[0], 2), 20) : motion.labels.length > 0 ? 8 : 4;
  let frame = motion.vibration ? 0 : last, phase = 0.25, started = null;
  let scale = 1, height = 1, width = 1;

  function fit() {
    width = canvas.clientWidth;
    const [w, h] = motion.size.map((n) => Math.max(n, 1));
    const tallest = Math.max(240, Math.min(430, 0.62 * width));
    scale = Math.min((width - 2 * margin) / w, (tallest - 2 * margin) / h);
    height = Math.max(scale * h + 2 * margin, 110);
    const ratio = window.devicePixelRatio || 1;
    canvas.style.height = height + "px";
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    draw();
  }
  const left = () => (width - scale * motion.size[0]) / 2;
  const bottom = () => (height + scale * motion.size[1]) / 2;

  function path(lines, style, thick, dash) {
    context.lineWidth = thick;
    context.lineJoin = context.lineCap = "round";
    context.setLineDash(dash);
    lines.forEach((line, beam) => {
      context.strokeStyle = style || colours[beam % colours.length];
      context.beginPath();
      for (let i = 0; i < line.length; i += 2) context.lineTo(left() + scale * line[i], bottom() - scale * line[i + 1]);
      context.stroke();
    });
    context.setLineDash([]);
  }

  // A bar of round length, in place of axes.
  function ruler() {
    const metre = scale / motion.cell, power = 10 ** Math.floor(Math.log10(120 / metre));
    const bar = [5, 2, 1].find((d) => d * power * metre <= 120) * power;
    context.strokeStyle = context.fillStyle = "#666";
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(12, height - 8);
    context.lineTo(12 + bar * metre, height - 8);
    context.stroke();
    context.font = "12px system-ui, sans-serif";
    context.fillText(Number(bar.toPrecision(1)) + " m", 12, height - 13);
  }

  function draw() {
    context.clearRect(0, 0, width, height);
    path(motion.ground, "#777", 1.6, []);
    path(motion.rest, "#aaa", 1.2, [6, 5]);
    let lines = motion.frames[frame];
    if (motion.vibration) {
      const swing = Math.sin(2 * Math.PI * phase);
      lines = lines.map((line, b) => line.map((c, i) => motion.rest[b][i] + swing * (c - motion.rest[b][i])));
    } else {
      path(motion.frames[0], "#9cc", 1, []);
    }
    path(lines, null, 2.6, []);
    ruler();
    slider.value = frame;
    const value = motion.parameter[frame];
    const shown = value === null ? "" : Number(value.toPrecision(5)).toString().replace("-", "−");
    output.textContent = motion.labels[frame] || motion.name + (motion.vibration ? " " + (frame + 1) : "") + ": " + shown + " " + motion.unit;
  }

  function tick(now) {
    if (started === null) return;
    // The first picture may carry a time before the click that asked for it.
    const seconds = Math.max(0, now - started) / 1000;
    if (motion.vibration) {
      phase = 0.25 + seconds / 2;
    } else {
      const first = motion.parameter[0], span = motion.parameter[last] - first;
      const until = first + Math.min(seconds / duration, 1) * span;
      // By the parameter where it grows, by number along a path that turns back.
      frame = byTime ? Math.max(0, motion.parameter.findLastIndex((p) => p <= until))
        : Math.min(Math.floor((seconds / duration) * count), last);
      if (seconds >= duration) { frame = last; stop(); }
    }
    draw();
    requestAnimationFrame(tick);
  }
  function stop() { started = null; button.textContent = "▶ play"; }
  function play() {
    if (frame === last && !motion.vibration) frame = 0;
    let done = last > 0 ? frame / last : 0;
    const span = motion.parameter[last] - motion.parameter[0];
    if (byTime && span > 0) done = (motion.parameter[frame] - motion.parameter[0]) / span;
    started = performance.now() - 1000 * (motion.vibration ? 2 * (phase - 0.25) : done * duration);
    button.textContent = "❚❚ pause";
    requestAnimationFrame(tick);
  }
  button.onclick = () => (started === null ? play() : stop());
  slider.max = last;
  slider.oninput = () => { if (!motion.vibration) stop(); frame = Number(slider.value); draw(); };
  window.addEventListener("resize", fit);
  fit();
})();
