// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace fieldcast::report {

/// The style sheet of all pages.
inline constexpr std::string_view kStyle = R"css(
:root {
  --page: #fbfbf9; --card: #ffffff; --ink: #1d2024; --soft: #626973; --line: #dfe2e6; --bar: #b4bdc6; --ours: #14708c;
  --cold: #f2f4f5; --hot: #8fc7d6;
  --s0: #14708c; --s1: #d0802f; --s2: #5c9440; --s3: #8c5fae; --s4: #bb4d62; --s5: #7c838c; --s6: #bfa022; --s7: #3f9f96;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #14171a; --card: #1b1f23; --ink: #e7e9eb; --soft: #9ba3ac; --line: #2d3238; --bar: #56606a; --ours: #53b4d1;
    --cold: #22272c; --hot: #1f6478;
    --s0: #4aaac7; --s1: #d9914a; --s2: #7fb562; --s3: #ac85cb; --s4: #d4707f; --s5: #8d959e; --s6: #c9ad3f; --s7: #56b5ac;
  }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 16px/1.55 system-ui, sans-serif; }
main { max-width: 66rem; margin: 0 auto; padding: 2.5rem 1.1rem 4rem; }
header { border-bottom: 1px solid var(--line); margin-bottom: 2rem; }
h1 { font-size: 1.75rem; line-height: 1.2; margin: 0 0 .4rem; letter-spacing: -.01em; text-wrap: balance; }
h2 { font-size: 1.15rem; margin: 0 0 .8rem; letter-spacing: -.005em; }
.lead { font-size: 1.06rem; color: var(--soft); margin: 0 0 1.4rem; max-width: 46rem; }
section { margin: 0 0 2.6rem; }
p { max-width: 46rem; margin: 0 0 1rem; }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: .6rem; padding: 1rem 1.1rem;
  min-width: 0; }
figcaption { font-weight: 600; margin-bottom: .6rem; }
.note { font-weight: 400; color: var(--soft); font-size: .88em; margin-left: .6em; }
.beside { display: grid; gap: 1rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 19rem), 1fr));
  margin-bottom: 1rem; }
.bars { display: grid; grid-template-columns: fit-content(10rem) minmax(3rem, 1fr) max-content; gap: .12rem .8rem;
  align-items: center; align-content: start; font-size: .92rem; }
.bars figcaption { grid-column: 1 / -1; font-size: 1rem; }
.row { display: contents; } .label { overflow-wrap: anywhere; }
.value { text-align: right; font-variant-numeric: tabular-nums; }
.strong { font-weight: 700; }
svg { display: block; overflow: visible; }
svg text { fill: var(--soft); font-size: 12px; font-variant-numeric: tabular-nums; }
svg text.inside { fill: #fff; font-weight: 600; }
.bar { fill: var(--bar); } .bar.ours { fill: var(--ours); }
.grid { stroke: var(--line); stroke-width: 1; }
.stroke { stroke-width: 2.5; fill: none; stroke-linecap: round; }
.s0 { fill: var(--s0); background: var(--s0); stroke: var(--s0); } .s1 { fill: var(--s1); background: var(--s1); stroke: var(--s1); }
.s2 { fill: var(--s2); background: var(--s2); stroke: var(--s2); } .s3 { fill: var(--s3); background: var(--s3); stroke: var(--s3); }
.s4 { fill: var(--s4); background: var(--s4); stroke: var(--s4); } .s5 { fill: var(--s5); background: var(--s5); stroke: var(--s5); }
.s6 { fill: var(--s6); background: var(--s6); stroke: var(--s6); } .s7 { fill: var(--s7); background: var(--s7); stroke: var(--s7); }
.curve { stroke-width: 2; fill: none; vector-effect: non-scaling-stroke; stroke-linejoin: round; }
.stack { border-radius: .35rem; overflow: hidden; margin-bottom: 1rem; } .stack rect { stroke: none; }
.stack-label .value { white-space: nowrap; }
.stack-label { display: flex; justify-content: space-between; gap: 1rem; font-size: .92rem; margin-bottom: .2rem; }
.legend { list-style: none; display: flex; flex-wrap: wrap; gap: .25rem 1.1rem; margin: .7rem 0 0; padding: 0;
  font-size: .88rem; color: var(--soft); }
.legend i { display: inline-block; width: .75em; height: .75em; border-radius: .18em; margin-right: .45em; }
.scroll { overflow-x: auto; margin-bottom: 1rem; border: 1px solid var(--line); border-radius: .6rem; background: var(--card); }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
.numbers { width: 100%; font-size: .9rem; }
.numbers th, .numbers td { padding: .42rem .7rem; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--line); }
.numbers th:first-child { text-align: left; position: sticky; left: 0; background: var(--card); }
.numbers thead th { color: var(--soft); font-weight: 500; } .numbers tbody th { font-weight: 500; }
.numbers tbody tr:last-child > * { border-bottom: 0; }
.numbers .ours > * { font-weight: 700; color: var(--ours); }
.heat { width: 100%; table-layout: fixed; font-size: .8rem; border-spacing: 2px; border-collapse: separate; }
.heat td { text-align: center; padding: .5rem 0; border-radius: .25rem; background: var(--cold);
  background: color-mix(in srgb, var(--hot) var(--heat), var(--cold)); }
dl { display: grid; grid-template-columns: minmax(7rem, max-content) 1fr; gap: .35rem 1.2rem; font-size: .92rem; margin: 0; }
dt { font-weight: 600; } dd { margin: 0; color: var(--soft); overflow-wrap: anywhere; }
.viewer { margin-bottom: 1rem; }
.viewer input { position: absolute; opacity: 0; pointer-events: none; }
.viewer label { display: inline-block; padding: .3rem .8rem; margin: 0 .3rem .5rem 0; border: 1px solid var(--line);
  border-radius: 1rem; font-size: .88rem; cursor: pointer; user-select: none; }
.viewer input:checked + label { background: var(--ours); border-color: var(--ours); color: var(--page); font-weight: 600; }
.viewer input:focus-visible + label { outline: 2px solid var(--ink); outline-offset: 2px; }
.stage > .picture { display: none; }
.picture { width: 100%; background-size: 100% 100%; image-rendering: pixelated; border-radius: .3rem; background-color: #000;
  -webkit-print-color-adjust: exact; print-color-adjust: exact; }
.pictures { display: grid; gap: .9rem; grid-template-columns: repeat(auto-fill, minmax(min(47%, 15rem), 1fr)); }
.pictures > .first { grid-column-start: 1; }
.pictures div > span { display: block; font-size: .86rem; margin-top: .3rem; }
.pictures .numbers-of { color: var(--soft); font-variant-numeric: tabular-nums; }
.scale { height: .7rem; border-radius: .35rem; max-width: 22rem; margin: .2rem 0; }
.ends { display: flex; justify-content: space-between; max-width: 22rem; font-size: .82rem; color: var(--soft); }
@media (max-width: 34rem) {
  main { padding-top: 1.5rem; } h1 { font-size: 1.4rem; }
  dl { grid-template-columns: 1fr; gap: .1rem; } dd { margin-bottom: .5rem; }
  .heat { font-size: .68rem; } svg text.narrow { display: none; }
}
@media print { .viewer { display: none; } section, figure { break-inside: avoid; } }
)css";

} // namespace fieldcast::report
