// How the page of report_html looks, in light and in dark. Nine colours that people with colour-blindness tell apart
// (after Okabe and Ito, "Color Universal Design", 2008), for up to nine families or phases.
#pragma once

#include <string_view>

namespace splice::bench {

inline constexpr std::string_view kReportStyle = R"(:root {
  color-scheme: light dark;
  --page: #ffffff; --ink: #1b1f24; --faint: #5b6470; --rule: #dfe3e8; --panel: #f5f7f9; --edge: #8a94a3;
  --good: #00785a; --short: #b4450a; --halo: #ffffffb0;
  --c0: #0072b2; --c1: #e69f00; --c2: #009e73; --c3: #cc79a7; --c4: #56b4e9; --c5: #d55e00; --c6: #7a7f87;
  --c7: #8e6bbf; --c8: #a3a000;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #14171b; --ink: #e8eaed; --faint: #9aa4b0; --rule: #2d333b; --panel: #1d2127; --edge: #6f7a88;
    --good: #3fc29b; --short: #f0894d; --halo: #14171bb0;
    --c0: #3d9bd6; --c1: #f0b232; --c2: #2fbf94; --c3: #dc92bb; --c4: #7cc7f2; --c5: #ec7a2c; --c6: #9aa0a8;
    --c7: #ac8fd6; --c8: #c2bf2a;
  }
}
body { background: var(--page); color: var(--ink); font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; margin: 0; }
main { max-width: 1080px; margin: 0 auto; padding: 24px 20px 60px; }
h1 { font-size: 26px; margin: 0; }
h2 { font-size: 18px; margin: 0; }
figure, section { margin: 36px 0 0; }
.caption { color: var(--faint); margin: 2px 0 12px; }
.drawing { overflow-x: auto; }
svg { max-width: 100%; height: auto; display: block; font: 12px system-ui, "DejaVu Sans", sans-serif; }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(190px, 1fr)); gap: 12px; margin-top: 20px; }
.tile { background: var(--panel); border-left: 4px solid var(--good); border-radius: 6px; padding: 10px 14px; }
.tile.short { border-color: var(--short); }
.tile b { display: block; font-size: 24px; font-weight: 600; }
.tile span, .tile small { display: block; line-height: 1.35; }
.tile small { color: var(--good); margin-top: 4px; }
.tile.short small { color: var(--short); }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 13px; white-space: nowrap; }
th, td { padding: 4px 12px 4px 0; text-align: right; border-bottom: 1px solid var(--rule); }
th { color: var(--faint); font-weight: 500; }
th:first-child, td:first-child, td:nth-child(2), th:nth-child(2) { text-align: left; }
text { fill: var(--ink); }
.label { fill: var(--faint); } .strong { fill: var(--ink); } .small { font-size: 10px; fill: var(--faint); }
.axis { stroke: var(--edge); } .grid { stroke: var(--rule); }
.curve { fill: none; stroke-width: 2; } .leader { stroke-width: 1; opacity: 0.5; }
.bound { stroke: var(--short); stroke-dasharray: 5 4; stroke-width: 1.5; }
.alive { fill: none; stroke: var(--ink); stroke-width: 1.5; }
.live { stroke: var(--page); stroke-width: 1; fill-opacity: 0.72; }
.inside { font-size: 10px; paint-order: stroke; stroke: var(--halo); stroke-width: 3px; stroke-linejoin: round; }
.group { fill: var(--panel); stroke: var(--c0); stroke-width: 1.5; }
.cell { fill: var(--page); stroke: var(--edge); } .pass { font-size: 11px; }
.edge { fill: none; stroke: var(--edge); stroke-width: 1.2; opacity: 0.7; }
.edge:hover { stroke: var(--c5); stroke-width: 2.5; opacity: 1; }
.s0 { stroke: var(--c0); } .s1 { stroke: var(--c1); } .s2 { stroke: var(--c2); } .s3 { stroke: var(--c3); }
.s4 { stroke: var(--c4); } .s5 { stroke: var(--c5); } .s6 { stroke: var(--c6); } .s7 { stroke: var(--c7); }
.s8 { stroke: var(--c8); }
.f0 { fill: var(--c0); } .f1 { fill: var(--c1); } .f2 { fill: var(--c2); } .f3 { fill: var(--c3); }
.f4 { fill: var(--c4); } .f5 { fill: var(--c5); } .f6 { fill: var(--c6); } .f7 { fill: var(--c7); }
.f8 { fill: var(--c8); }
)";

}  // namespace splice::bench
