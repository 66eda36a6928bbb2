#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Makes vcg_core/what_steers_the_result.md from the code: every tuned constant with the reason beside it, and every place
where the result depends on a threshold of noise, of points per vertex or of the vertices asked for.

    constants_page.py            writes the page
    constants_page.py --check    ends with code 1 if the page is out of date
"""

import re
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = "vcg_core/what_steers_the_result.md"

# What no result depends on, or no tuning: expressions that PATH:NAME has to match, and why.
INERT = [
    (r":k(\w*Chunk|\w*AtATime|Lanes|Packets|InBatch|Batch|MostChunks)$",
     "how work is divided between threads and lanes"),
    (r"base/(thread_team|platform|parallel_for)\.|engine/basic_step_batch\.cpp:"
     r"kLeastPerThread|:kAdaptEvery$|engine/basic_step_batch\.h:kMost$|:kLeastOrdered$|:kLeastOutOfCache$|"
     r":k\w*Ahead$|:kPrefetchDistance$|"
     r"base/lazy_priority_queue\.h:", "speed: the same result"),
    (r"engine/(winner_search|scaled_numbers|eight_steps\.cpp|eight_steps\.h:kMost$)|mesh/face_tree|"
     r"cloud/nearest_points|start/clearance",
     "a search or an order: an exact result, found faster"),
    (r"base/(logarithm|random|colors_and_normals|even_mesh)\.h:|:k(PiF|White|DegreesPerRadian|DeviationPerMedian|UnitBallVolume|"
     r"Ln2|Pi|HalfTurn|NeighbourCount|AllNeighbours|MaxLevel|NormalQuantile|RegularValence|RegularBoundaryValence)$|"
     r":kWithin30Degrees$|learn_to_error\.cpp:kLeast$", "mathematics"),
    (r":k(None|NoVertex|NoNormal|Sentinel|FreeSlot|Nobody|Outside|Zero|End|Never|Unset|Unlimited|Far|Middle|Max)$",
     "a mark for nothing"),
    (r":k(Tiny|Rounding|LeastRounding|SquaredRounding|LeastSize|Ridge|Collinear|Margin)$|"
     r"mesh/self_intersections|local_quadric\.cpp:kLine|error_search\.cpp:kBits|points_by_face\.cpp:kSteps",
     "rounding, and division by nothing"),
    (r":k(MaxValence|HighestValence|Stride|Places|WordsAround|Leaf|LeafFaces|Branch|Stack|FilterBits|"
     r"MostBits|MaxNodesPerSide|MaxSquaredDepth|MostSignals|MostParts)$", "sizes of arrays and numbers"),
    (r":k(Prepared|Learned|ShellMade|ReportEvery)$", "shares of the progress"),
    (r"write_result\.cpp:kDistanceSamples|settings\.cpp:|mesh_io\.cpp:", "the report, or the range of a parameter"),
]

UNITS = [  # an expression that the name or the comment has to match; the first that does
    (r"Cosine|\bcosine\b", "cosine"), (r"Degrees|\bdegrees\b", "degrees"), (r"Radii|\bradi(i|us)\b", "radii"),
    (r"Spacings?\b|\bspacings?\b", "spacings"), (r"Deviations|\bdeviations?\b", "deviations"),
    (r"Variances|\bvariances?\b", "variances"), (r"Rounds?\b|Passes|\brounds?\b", "rounds"), (r"\bRings|\brings?\b", "rings"),
    (r"Steps|\blattice steps?\b|\bsteps?\b", "steps"), (r"Share|\bshares?\b", "share"), (r"PerVertex", "per vertex"),
    (r"Edges?\b|\bedges\b|\bedge length", "edges"), (r"Signals|\bsignals\b", "signals"), (r"Vertices|\bvertices\b", "vertices"),
    (r"Points|Fewest|\bpoints\b", "points"), (r"Faces|\bfaces\b", "faces"), (r"\btimes\b", "times"), (r"Weight", "weight"),
]

MEASURED = re.compile(r"_table|of the error|times the error|error of|shell_topology|measured|logistic|\bmodels?\b|bunny|fandisk"
                      r"|kitten|feline|koala|block|armadillo|homer|turbine|genus3|eight\b")
# Places where the result depends on a threshold: statements about one of the subjects that compare with a number or a
# constant, are bounded by one, or choose between two. In NO_RESULT they decide about speed alone.
SUBJECT = re.compile(
    r"[nN]oise|variance|\bcalm\b|[dD]eviation"
    r"|points_per_vertex|\bper_vertex\(|(?<!Signals)(?<!Wins)PerVertex\b|PerCarried|PerLearned|PrecisePoints|FewestToFill"
    r"|PointsPer(Part|Node)"
    r"|(target|final|wanted|fewest)_vertices|most_wanted|\bcarried\b|grow_to|reduce_to|VerticesToHold|DenseFrom|ByVolumeFrom")
BOUND = re.compile(r"^(?=.*([<>]|\b(clamp|min|max)\())(?=.*(\bk[A-Z]\w*|(?<![\w.])([2-9]|1\d)\d*\b))|\?.*\bk[A-Z]\w*|\? \d+ : \d+")
NO_RESULT = ("learning/memory_order.h",)
CONSTANT = re.compile(r"^\s*(?:inline |static )*constexpr (?!const char)([\w:<>]+) (k[A-Z].*)$")
DECLARED = re.compile(r"(k[A-Z]\w*)(?:\[\w*\])? ?(?:= ?|(?=\{))((?:\{.*?\}|[^,{]|,(?! k[A-Z]))+)")
FUNCTION = re.compile(r"\bconstexpr [\w:<>]+ \w+\(")


@dataclass
class Constant:
    path: str
    names: list
    values: list
    reason: str
    above: bool = False  # the reason is that of the row above

    def where(self):
        return [f"{self.path}:{name}" for name in self.names]


def plain(comment):
    return re.sub(r"\s+", " ", re.sub(r"\\p ", "", comment)).strip()


def comment_of(line):
    """The text of a line that is a comment, or nothing."""
    found = re.match(r"^\s*///?<?\s?(.*)$", line)
    return None if found is None else found[1]


def constants_of(path, text):
    """The constants of one file."""
    lines, result, comment, last_was_constant = text.splitlines(), [], [], False
    i = 0
    while i < len(lines):
        line = lines[i]
        i += 1
        words = comment_of(line)
        if words is not None:
            comment = comment + [words] if not last_was_constant else [words]
            last_was_constant = False
            continue
        if not CONSTANT.match(line) or FUNCTION.search(line):
            comment, last_was_constant = [], False
            continue
        code, beside = line, ""
        while True:
            code, _, more = code.partition("//")
            beside += " " + more.lstrip("/<") if more else ""
            if ";" in code or i >= len(lines):
                break
            code += " " + lines[i].strip()
            i += 1
        while beside and i < len(lines) and re.match(r"^\s+///<", lines[i]):
            beside += " " + comment_of(lines[i])
            i += 1
        declared = DECLARED.findall(CONSTANT.match(code.split(";")[0]).group(2))
        above = not beside and last_was_constant and bool(result) and bool(comment)
        result.append(Constant(path, [name for name, _ in declared], [value.strip() for _, value in declared],
                               plain(beside) or plain(" ".join(comment)), above))
        last_was_constant = True
    return result


def files(root):
    return sorted(path for path in (root / "vcg_core").rglob("*.[hc]*") if path.suffix in (".h", ".cpp"))


def all_constants(root):
    return [constant for path in files(root)
            for constant in constants_of(str(path.relative_to(root / "vcg_core")), path.read_text())]


def why_inert(constant):
    """Why no result depends on it, or nothing."""
    for expression, reason in INERT:
        if all(re.search(expression, where) for where in constant.where()):
            return reason
    return None


def unit_of(constant):
    for expression, unit in UNITS:
        if any(re.search(expression, name) for name in constant.names):
            return unit
    for expression, unit in UNITS:
        if re.search(expression, constant.reason):
            return unit
    return ""


def thresholds(root):
    """(path, statement) of every place that depends on a threshold."""
    for path in files(root):
        name = str(path.relative_to(root / "vcg_core"))
        code = re.sub(r"//[^\n]*|/\*.*?\*/", "", path.read_text(), flags=re.DOTALL)
        code = re.sub(r'\s*(?:&&|\|\|)\s*!?skips\("\w+"\)', "", code)  # of development builds
        code = re.sub(r'"(?:[^"\\\n]|\\.)*"', '""', code)
        for statement in (" ".join(part.split()) for part in re.split(r"[;{}]", code)) if name not in NO_RESULT else ():
            bare = re.sub(r"\b\w+(?:::\w+)*<[\w:,&* ]*>", "", re.sub(r"->|<<|>>", "", statement))
            if SUBJECT.search(statement) and BOUND.search(bare) and not re.match(
                    r"#|(static |inline )*constexpr|for \(|.*\bthrow\b", statement):
                yield name, statement


def cell(text):
    return text.replace("|", "\\|")


def folder_of(path):
    return path.split("/")[0] + "/" if "/" in path else "vcg_core/"


def page(root):
    """The text of the page."""
    constants = all_constants(root)
    tuned = [c for c in constants if why_inert(c) is None]
    inert = [c for c in constants if why_inert(c) is not None]
    places = list(thresholds(root))
    folders = sorted({folder_of(c.path) for c in constants})

    def count(of, folder):
        return sum(len(c.names) for c in of if folder_of(c.path) == folder)

    measured = [c for c in tuned if MEASURED.search(c.reason)]
    bare = [c for c in tuned if not c.reason]
    out = ["# What steers the result", "",
           "`tests/constants_page.py` makes this page from the code; a test says if it is out of date. The reasons are the "
           "comments beside the constants. The parameters that users set are in `settings.h`.", "",
           "| folder | tuned constants | with a measurement in the reason | without a reason | no result depends on |",
           "|---|---|---|---|---|"]
    for folder in folders:
        out.append(f"| `{folder}` | {count(tuned, folder)} | {count(measured, folder)} | {count(bare, folder)} | "
                   f"{count(inert, folder)} |")
    out += ["| all | " + " | ".join(str(sum(count(of, folder) for folder in folders))
                                    for of in (tuned, measured, bare, inert)) + " |", "",
            f"{len(places)} places have thresholds of noise, of points per vertex or of the vertices asked for.", ""]
    for folder in folders:
        rows = [c for c in tuned if folder_of(c.path) == folder]
        if not rows:
            continue
        out += [f"## `{folder}`", "", "| file | constant | value | unit | reason |", "|---|---|---|---|---|"]
        for c in rows:
            name = c.path.split("/", 1)[-1]
            out.append(f"| `{name}` | {', '.join(f'`{n}`' for n in c.names)} | {cell(', '.join(c.values))} | {unit_of(c)} | "
                       f"{'as above' if c.above and c.reason else cell(c.reason)} |")
        out.append("")
    out += ["## Places with thresholds", "", *(f"- `{path}`: `{statement}`" for path, statement in places)]
    out += ["", "## No result depends on", "", "| constants | why |", "|---|---|"]
    for reason in dict.fromkeys(why_inert(c) for c in inert):
        names = [f"`{where}`" for c in inert if why_inert(c) == reason for where in c.where()]
        out.append(f"| {', '.join(names)} | {reason} |")
    return "\n".join(out) + "\n"


def is_current(root):
    path = root / PAGE
    return path.exists() and path.read_text() == page(root)


def main(arguments):
    if arguments == ["--check"]:
        return 0 if is_current(ROOT) else f"{PAGE} is out of date: run tests/constants_page.py."
    (ROOT / PAGE).write_text(page(ROOT))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
