"""Opens pages in a browser and says what is wrong with them.

    python3 look.py pages.json

`pages.json` is {"screenshots": folder, "pages": [{"name", "kind", "file", …}]}; `kind` is
`run`, `cost` or `report`. Printed is, as JSON, the browser and for every page its number of
pictures, of compared numbers and of frames seen, and its problems: an empty list where nothing
is wrong.
"""

import csv
import json
import math
import pathlib
import re
import sys
import time

from webdriver import Browser

WIDE, NARROW, HEIGHT = 1200, 420, 900
# The player's colours of beams.
COLOURS = [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [60, 60, 60]]

# The dots of a canvas, from a copy: one that is read often would be told so on the console.
DOTS = """
const dots = (canvas) => {
  const copy = new OffscreenCanvas(canvas.width, canvas.height)
    .getContext("2d", { willReadFrequently: true });
  copy.drawImage(canvas, 0, 0);
  return copy.getImageData(0, 0, canvas.width, canvas.height).data;
};
"""

# Every picture that is shown: its size, and how many marks in colour lie in it. Axes and grids
# are grey.
PICTURES = DOTS + """
const spread = ([r, g, b]) => Math.max(r, g, b) - Math.min(r, g, b);
const shown = (e) => e.checkVisibility() && e.getBoundingClientRect().width > 0;
const colour = (text) => {
  const n = (text.match(/[\\d.]+/g) || []).map(Number);
  const there = text !== "none" && n.length >= 3 && (n.length < 4 || n[3] > 0);
  return there && spread(n) > 30;
};
return [...document.querySelectorAll("figure")].filter((f) => f.checkVisibility()).map((figure) => {
  const caption = (figure.querySelector("figcaption")?.textContent || "").trim().slice(0, 60);
  const picture = figure.querySelector("svg, canvas");
  const none = { caption, kind: "none", width: 0, height: 0, marks: 0, words: figure.textContent };
  if (!picture) return none;
  const box = picture.getBoundingClientRect();
  const [kind, words] = [picture.localName, picture.textContent];
  const found = { caption, kind, width: box.width, height: box.height, marks: 0, words };
  if (picture.localName === "svg") {
    const marks = picture.querySelectorAll("polyline, path, line, circle, polygon, rect");
    found.marks = [...marks].filter((mark) => {
      const style = getComputedStyle(mark), at = mark.getBoundingClientRect();
      return shown(picture) && at.width + at.height > 0.5
        && (colour(style.stroke) || colour(style.fill))
        && at.right > box.left && at.left < box.right && at.bottom > box.top && at.top < box.bottom;
    }).length;
  } else {
    const all = dots(picture);
    for (let i = 0; i < all.length; i += 4)
      if (all[i + 3] > 100 && spread(all.subarray(i, i + 3)) > 30) found.marks++;
  }
  return found;
});
"""

TABLES = """
const tables = [...document.querySelectorAll(arguments[0])].filter((t) => t.checkVisibility());
return tables.map((table) => ({
  caption: table.caption ? table.caption.textContent : "", grid: table.classList.contains("grid"),
  rows: [...table.rows].map((row) => [...row.cells].map((cell) => cell.innerText.trim())),
}));
"""

# What the player shows: words, and a number for the picture (FNV-1a) with the box of the beams'
# colours.
PLAYER = DOTS + """
const [colours] = arguments, player = document.getElementById("player");
const [canvas, slider, output, button] =
  ["canvas", "input", "output", "button"].map((name) => player.querySelector(name));
const all = dots(canvas);
let hash = 2166136261, low = [1e9, 1e9], high = [-1e9, -1e9];
for (let i = 0; i < all.length; i += 4) {
  const dot = all[i] | all[i + 1] << 8 | all[i + 2] << 16 | all[i + 3] << 24;
  hash = Math.imul(hash ^ dot, 16777619);
  const of = (c) => [0, 1, 2].reduce((sum, k) => sum + Math.abs(all[i + k] - c[k]), 0) < 24;
  if (all[i + 3] > 250 && colours.some(of)) {
    const at = [(i / 4) % canvas.width, Math.floor(i / 4 / canvas.width)];
    for (const k of [0, 1]) {
      low[k] = Math.min(low[k], at[k]);
      high[k] = Math.max(high[k], at[k]);
    }
  }
}
return { hash, low, high, frame: Number(slider.value), last: Number(slider.max),
  words: output.textContent, button: button.textContent };
"""

SLIDE = """
const slider = document.querySelector("#player input");
slider.value = arguments[0];
slider.dispatchEvent(new Event("input"));
"""


def number(text):
    """A number as our pages write it: −1.5 × 10⁻⁹."""
    text = text.replace("−", "-").translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-"))
    mantissa, _, exponent = text.partition(" × 10")
    return float(mantissa) * 10.0 ** int(exponent or 0)


def same(text, value, digits):
    """Whether a text is this number with so many digits."""
    try:
        shown = number(text)
    except ValueError:
        return False
    if value == 0.0 or not math.isfinite(value):
        return shown == value
    unit = 10.0 ** (math.floor(math.log10(abs(value))) + 1 - digits)
    return abs(shown - value) <= 0.5000001 * unit


def table(path):
    """A CSV file as a list of dictionaries."""
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class Look:
    """A page with what was found on it."""

    def __init__(self, browser, page, screenshots):
        self.browser, self.page = browser, page
        self.screenshot = pathlib.Path(screenshots) / page["name"]
        self.file = pathlib.Path(page["file"])
        self.problems, self.pictures, self.numbers, self.frames = [], 0, 0, 0

    def wrong(self, problem):
        self.problems.append(problem)

    def equal(self, what, text, value, digits):
        """A number on the page against that of a file."""
        self.numbers += 1
        if not same(text, value, digits):
            self.wrong(f"number: {what} is shown as {text}, the file has {value!r}")

    def look(self):
        self.browser.messages()
        self.browser.resize(WIDE, HEIGHT)
        self.browser.open(self.file.resolve().as_uri())
        if self.browser.run("return performance.getEntriesByType('resource').length") != 0:
            self.wrong("network: the page asks for other files")
        getattr(self, self.page["kind"])()
        for message in self.browser.messages():
            self.wrong(f"console: {message}")
        names = ["name", "problems", "pictures", "numbers", "frames"]
        return dict(
            zip(names, [self.page["name"], self.problems, self.pictures, self.numbers, self.frames])
        )

    def fits(self, where):
        """Nothing is wider than the window."""
        for width in [NARROW, WIDE]:
            self.browser.resize(width, HEIGHT)
            wide = self.browser.run("return document.scrollingElement.scrollWidth")
            if wide > width:
                self.wrong(f"layout: {where} is {wide} wide in a window of {width}")
        # In a wide window no column of a table is out of sight.
        hidden = self.browser.run(
            "return [...document.querySelectorAll('.scroll')]"
            ".filter((e) => e.scrollWidth > e.clientWidth + 1).length"
        )
        if hidden:
            self.wrong(f"layout: {where} has a table wider than its place")

    def drawn(self, where, expected=None):
        """Every picture has a size and something in it."""
        pictures = self.browser.run(PICTURES)
        self.pictures += len(pictures)
        for k, p in enumerate(pictures):
            what = f"picture {k + 1} of {where} ({p['kind']}, {p['caption']})"
            if min(p["width"], p["height"]) < 40:
                self.wrong(f"picture: {what} is {p['width']} × {p['height']}")
            elif p["marks"] == 0:
                self.wrong(f"picture: {what} has nothing in it")
            if re.search(r"NaN|not a number|nothing to draw|undefined", p["words"]):
                self.wrong(f"picture: {what} says {p['words'][:80]}")
        svg = sum(p["kind"] == "svg" for p in pictures)
        if expected is not None and svg != expected:
            self.wrong(f"picture: {where} has {svg} drawings where {expected} lie beside it")

    def cost(self):
        """What `ancf cost` leaves."""
        self.drawn("the page", len(list(self.file.parent.glob("*.svg"))))
        self.fits("the page")
        self.browser.picture(self.screenshot.with_suffix(".png"))
        measured = sorted(
            table(self.file.parent / "cost.csv"), key=lambda row: float(row["seconds"])
        )
        [shown] = self.browser.run(TABLES, "table.numbers")
        if len(shown["rows"]) - 1 != len(measured):
            self.wrong(
                f"number: {len(shown['rows']) - 1} settings are shown, cost.csv has {len(measured)}"
            )
        for cells, row in zip(shown["rows"][1:], measured):
            if cells[:3] != [row["discretization"], row["cells"], row["solver"]]:
                self.wrong(f"number: {cells[:3]} stands where cost.csv has {row}")
                continue
            if row["below_uncertainty"] == "false":
                self.equal("an error", cells[4], float(row["error"]), 2)
            for cell, key in [(5, "curvature_error"), (6, "energy_error")]:
                if row[key]:
                    self.equal(key, cells[cell], float(row[key]), 2)
            self.equal("a time", cells[7], 1e3 * float(row["seconds"]), 3)
            counts = f"{row['tangent_evaluations']}, {row['factorizations']}"
            self.numbers += 1
            if cells[8] != counts:
                self.wrong(f"number: counts {cells[8]} where cost.csv has {counts}")

    def report(self):
        """The verification report: one page at a time, all cases."""
        cases = {
            c["name"]: c for c in json.loads(pathlib.Path(self.page["json"]).read_text())["cases"]
        }
        pages = self.browser.run(
            "return [...document.querySelectorAll('section.page')].map((s) => s.id)"
        )
        if missing := set(cases) - set(pages):
            self.wrong(f"page: there is none for {sorted(missing)}")
        for page in pages:
            self.browser.run("location.hash = '#' + arguments[0]", page)
            shown = self.browser.run(
                "return [...document.querySelectorAll('section.page')]"
                ".filter((s) => s.checkVisibility()).map((s) => s.id)"
            )
            if shown != [page]:
                self.wrong(f"page: #{page} shows {shown}")
            self.drawn(page)
            self.fits(page)
            if page in cases:
                self.outcomes(cases[page])
            if page in self.page["pictures"]:
                self.browser.picture(
                    self.screenshot.with_name(f"{self.screenshot.name}-{page}.png")
                )

    def outcomes(self, case):
        """Errors of a case's page against report.json, in their order."""
        tables = self.browser.run(TABLES, "table")
        lines = [
            row for t in tables if not t["grid"] and len(t["rows"][0]) == 6 for row in t["rows"][1:]
        ]
        cells = sum(
            cell != "" for t in tables if t["grid"] for row in t["rows"][1:] for cell in row[1:]
        )
        if len(lines) + cells != len(case["outcomes"]):
            self.wrong(
                f"number: {case['name']} shows {len(lines) + cells} errors"
                f" of {len(case['outcomes'])}"
            )
        errors = iter([o["error"] for o in case["outcomes"]])
        for row in lines:
            text = re.sub(r"e(−?)(\d+)", lambda m: f" × 10{m[1]}{m[2]}", row[3])
            self.numbers += 1
            if not any(error is not None and same(text, error, 2) for error in errors):
                self.wrong(
                    f"number: the error {row[3]} of {case['name']} is not the next in report.json"
                )
                break

    def run(self):
        """What `ancf run` leaves."""
        folder = self.file.parent
        self.drawn("the page", len(list(folder.glob("*.svg"))))
        self.fits("the page")
        self.browser.picture(self.screenshot.with_suffix(".png"))
        shown = self.browser.run(TABLES, "table.numbers")
        shown = {t["caption"].split(" at ")[0]: t["rows"] for t in shown}
        if (folder / "probes.csv").exists():
            self.probes(shown, table(folder / "probes.csv")[-1])
            self.energies(shown, table(folder / "energy.csv"))
        for file, caption in [
            ("frequencies", "Natural frequencies"),
            ("load_factors", "Critical loads"),
        ]:
            if (folder / f"{file}.csv").exists():
                values = [float(list(row.values())[1]) for row in table(folder / f"{file}.csv")]
                rows = shown[caption][1:]
                if len(rows) != len(values):
                    self.wrong(f"number: {len(rows)} of {len(values)} {caption}")
                for row, value in zip(rows, values):
                    self.equal(caption, row[1].replace(" (nothing resists)", ""), value, 8)
        if "row" in self.page:
            self.row(shown["Probes"])
        if self.browser.run("return document.getElementById('player') !== null"):
            self.movie(folder)
        else:
            self.wrong("movie: there is none")

    def probes(self, shown, row):
        names = ["x", "y", "angle", "curvature", "strain", "vx", "vy"]
        rows = shown.get("Probes", [])[1:]
        if len(rows) * len(rows[0][1:] if rows else []) != len(row) - 1:
            self.wrong("number: the table of probes has not the columns of probes.csv")
        for cells in rows:
            for name, cell in zip(names, cells[1:]):
                value = float(row[f"{cells[0]}.{name}"])
                value = math.degrees(value) if name == "angle" else value
                # Of round-off one digit is shown.
                self.equal(f"{cells[0]}.{name}", cell, value, 7 if abs(value) > 1e-9 else 1)

    def energies(self, shown, rows):
        renamed = {"springs and contacts": "stored", "put in": "work"}
        total = [float(row["total"]) for row in rows]
        head, cells = shown["Energies"]
        for name, cell in zip(head[1:], cells[1:]):
            if name.startswith("drift"):
                moved = max(float(row["kinetic"]) for row in rows)
                self.equal("the drift", cell, max(abs(t - total[0]) for t in total) / moved, 3)
            else:
                self.equal(f"energy {name}", cell, float(rows[-1][renamed.get(name, name)]), 7)

    def row(self, shown):
        """A run of a sweep against its row in sweep.csv."""
        row = table(self.page["sweep"])[self.page["row"]]
        for cells in shown[1:]:
            for name, cell in zip(["x", "y"], cells[1:]):
                self.equal(f"of the sweep {name}", cell, float(row[f"probes.{cells[0]}.{name}"]), 7)

    # The movie.

    def player(self):
        return self.browser.run(PLAYER, COLOURS)

    def movie(self, folder):
        motion = json.loads(
            self.browser.run("return document.getElementById('motion').textContent")
        )
        start = self.player()
        last = len(motion["frames"]) - 1
        if start["last"] != last or start["frame"] != (0 if motion["vibration"] else last):
            self.wrong(
                f"movie: it begins at frame {start['frame']} of {start['last']}, {last} are there"
            )
        self.frames_are_those_of_the_files(motion, folder)
        if motion["vibration"]:
            self.swings()
        elif last > 0:
            self.plays(last)

    def frames_are_those_of_the_files(self, motion, folder):
        last, vibration = len(motion["frames"]) - 1, motion["vibration"]
        probes = None if vibration else table(folder / "probes.csv")
        eigen = [folder / "frequencies.csv", folder / "load_factors.csv"]
        eigen = next((table(path) for path in eigen if path.exists()), [])
        sizes = []
        for frame in sorted({0, last // 3, last // 2, last}):
            self.browser.run(SLIDE, frame)
            seen = self.player()
            label = seen["words"].split(": ")[-1].split(" ")[0]
            if vibration:
                self.equal("the movie's value", label, float(list(eigen[frame].values())[1]), 5)
                continue
            parameter = motion["parameter"][frame]
            row = next((r for r in probes if float(next(iter(r.values()))) == parameter), None)
            if row is None:
                self.wrong(
                    f"number: the movie's frame {frame} at {parameter} is in no row of probes.csv"
                )
                continue
            self.equal("the movie's parameter", label, parameter, 5)
            self.passes_through_the_probes(motion, frame, row)
            x = [c for line in motion["frames"][frame] for c in line[0::2]]
            y = [c for line in motion["frames"][frame] for c in line[1::2]]
            box = [max(x) - min(x), max(y) - min(y)]
            sizes.append((box, [seen["high"][k] - seen["low"][k] for k in (0, 1)]))
        # What is drawn has the size of what was computed, in one scale, to the thickness of a line.
        if sizes:
            box, drawn = max(sizes, key=lambda s: max(s[0]))
            scale = max(drawn) / max(box)
            for box, drawn in sizes:
                if any(abs(scale * b - d) > 6 for b, d in zip(box, drawn)):
                    self.wrong(
                        f"movie: beams of {box} cells are drawn with {drawn} dots,"
                        f" {scale:.4f} a cell"
                    )

    def passes_through_the_probes(self, motion, frame, row):
        for name in {key.rsplit(".", 1)[0] for key in row if key.endswith(".x")}:
            at = [
                (float(row[f"{name}.{c}"]) - o) / motion["cell"]
                for c, o in zip("xy", motion["origin"])
            ]
            points = [p for line in motion["frames"][frame] for p in zip(line[0::2], line[1::2])]
            beyond = min(math.dist(at, p) for p in points)
            steps = (math.dist(a, b) for a, b in zip(points, points[1:]))
            self.numbers += 1
            # A probe lies between two points; ends lie on one.
            if beyond > max(steps) + 2:
                self.wrong(
                    f"number: {name} is {beyond:.0f} cells beside the movie's beams"
                    f" in frame {frame}"
                )

    def until(self, done, seconds):
        """What the player shows until something is true; the time is for a machine that hangs."""
        seen, end = [], time.monotonic() + seconds
        while time.monotonic() < end:
            seen.append(self.player())
            if done(seen):
                break
            time.sleep(0.02)
        return seen

    def still(self, when):
        """Two pictures some time apart are one."""
        first = self.player()
        time.sleep(0.5)
        second = self.player()
        if first["hash"] != second["hash"] or first["words"] != second["words"]:
            self.wrong(f"movie: it goes on {when}")
        if "play" not in second["button"]:
            self.wrong(f"movie: its button says {second['button']} {when}")

    def plays(self, last):
        self.browser.run(SLIDE, 0)
        self.still("before it was begun")
        # Stopped on the way, and then to its end.
        self.browser.click("#player button")
        self.until(lambda seen: seen[-1]["frame"] > 0, 10)
        self.browser.click("#player button")
        if last > 20:
            self.still("when it was stopped")
            if not 0 < self.player()["frame"] < last:
                self.wrong("movie: stopped on the way it is not on the way")
        self.browser.run(SLIDE, 0)
        self.browser.click("#player button")
        if "pause" not in self.player()["button"]:
            self.wrong("movie: its button does not say that it plays")
        seen = self.until(lambda seen: "play" in seen[-1]["button"], 40)
        frames = [s["frame"] for s in seen]
        self.frames = len(set(frames))
        if frames[-1] != last:
            self.wrong(f"movie: it ends at frame {frames[-1]} of {last}")
        if frames != sorted(frames) or self.frames < min(last + 1, 3):
            self.wrong(f"movie: it does not advance: {sorted(set(frames))} of {last} were seen")
        if len({s["hash"] for s in seen}) < min(last + 1, 3):
            self.wrong("movie: its picture does not change")
        self.still("after its end")

    def swings(self):
        self.browser.click("#player button")
        seen = self.until(lambda seen: len({s["hash"] for s in seen}) > 5, 10)
        self.frames = len({s["hash"] for s in seen})
        if self.frames < 6:
            self.wrong("movie: the mode does not swing")
        self.browser.click("#player button")
        self.still("when it was stopped")


def main(path):
    wanted = json.loads(pathlib.Path(path).read_text())
    pathlib.Path(wanted["screenshots"]).mkdir(parents=True, exist_ok=True)
    with Browser(WIDE, HEIGHT) as browser:
        found = [Look(browser, page, wanted["screenshots"]).look() for page in wanted["pages"]]
        print(json.dumps({"browser": browser.name, "pages": found}))


if __name__ == "__main__":
    main(sys.argv[1])
