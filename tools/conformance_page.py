# SPDX-License-Identifier: Apache-2.0
"""The page of tools/conformance.py: summary, table and contact sheet. Needs no scripts and nothing from elsewhere."""
import html

RESULTS = {"crashed": "crashed", "timed_out": "timed out", "refused": "refused", "opened": "opened"}  # worst first
NOT_RUN = "not run"
HEADINGS = ("File", "Result", "Reason, or warnings", "Opening, s", "Render, s", "Peak memory, MB", "Triangles shown",
            "Extensions used")
STYLE = """
:root { color-scheme: light dark; font: 15px/1.4 system-ui, sans-serif; }
body { margin: 2rem; }
table { border-collapse: collapse; }
.wide { overflow-x: auto; }
th, td { padding: 0.25rem 0.7rem; text-align: left; vertical-align: top; border-bottom: 1px solid #8886; }
td { overflow-wrap: anywhere; }
td:first-child { min-width: 14rem; }
td:nth-child(2) { white-space: nowrap; font-weight: 600; }
.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; overflow-wrap: normal; }
.crashed td:nth-child(2), .timed_out td:nth-child(2) { background: #c62828; color: #fff; }
.refused td:nth-child(2) { background: #f9a825; color: #000; }
.warning { opacity: 0.75; }
.sheet { display: grid; grid-template-columns: repeat(auto-fill, minmax(160px, 1fr)); gap: 1rem; }
figure { margin: 0; }
figure img { display: block; width: 160px; height: 90px; background: #8884; }
figcaption { font-size: 0.8rem; overflow-wrap: anywhere; }
"""


def printable(text):
    """Replaces control characters, bidirectional controls and bytes that are not UTF-8 by their numbers."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(text))


def escaped(text):
    return html.escape(printable(text))


def number(value, decimals):
    return "" if value is None else f"{value:,.{decimals}f}"


def cell(content, kind=""):
    """`content` is HTML."""
    return f'<td class="{kind}">{content}</td>' if kind else f"<td>{content}</td>"


def extension_name(extension):
    """With a remark if the file requires the extension, or if the loader ignores it."""
    remarks = [word for word, holds in (("required", extension.get("is_required")),
                                        ("ignored", not extension.get("is_read", True))) if holds]
    return extension["name"] + (f" ({', '.join(remarks)})" if remarks else "")


def row(name, record):
    """One line of the table; `record` None: the file has not been tested."""
    if record is None:
        return f"<tr>{cell(escaped(name))}{cell(NOT_RUN)}{cell('') * 6}</tr>"
    reasons = [escaped(record["reason"])] if record["reason"] else []
    reasons += [f'<span class="warning">{escaped(warning)}</span>' for warning in record["warnings"]]
    cells = [cell(escaped(name)), cell(RESULTS[record["result"]]), cell("<br>".join(reasons))]
    for member, decimals in (("open_s", 2), ("render_s", 2), ("peak_mb", 0), ("triangles", 0)):
        cells.append(cell(number(record[member], decimals), "number"))
    cells.append(cell("<br>".join(escaped(extension_name(each)) for each in record["extensions"])))
    return f'<tr class="{record["result"]}">{"".join(cells)}</tr>'


def figure(name, record):
    return (f'<figure><img src="{html.escape(record["picture"])}" alt="" width="160" height="90" loading="lazy">'
            f"<figcaption>{escaped(name)}</figcaption></figure>")


def in_order(files):
    """Those that need attention first: not tested, crashed, timed out, refused, opened; then by name."""
    ranks = {result: rank for rank, result in enumerate(RESULTS)}
    return sorted(files, key=lambda file: (-1 if file[1] is None else ranks[file[1]["result"]], file[0]))


def write(folder, files, summary):
    """Writes folder/index.html. `files`: (name, record or None) of each; `summary`: how many have which result."""
    counts = "".join(f"<tr><th>{label}</th>{cell(str(summary[result]), 'number')}</tr>"
                     for result, label in [*reversed(RESULTS.items()), ("not_run", NOT_RUN)])
    heading = "".join(f"<th>{text}</th>" for text in HEADINGS)
    rows = "\n".join(row(*file) for file in in_order(files))
    figures = "\n".join(figure(*file) for file in sorted(files, key=lambda file: file[0])
                        if file[1] and file[1]["picture"] and (folder / file[1]["picture"]).exists())
    sheet = f'<h2>Pictures</h2>\n<div class="sheet">\n{figures}\n</div>' if figures else ""
    (folder / "index.html").write_text(f"""<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><title>glTF files in Fieldcast</title><style>{STYLE}</style></head>
<body>
<h1>glTF files in Fieldcast</h1>
<table><tr><th>files</th>{cell(str(len(files)), "number")}</tr>{counts}</table>
<h2>Files</h2>
<div class="wide"><table id="files">
<thead><tr>{heading}</tr></thead>
<tbody>
{rows}
</tbody></table></div>
{sheet}
</body>
</html>
""", encoding="utf-8")
