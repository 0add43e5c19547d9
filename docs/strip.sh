#!/bin/sh
# A model of one's own as a program: a sheet clamped at x0 bends like a strip under its own weight along z.
# sheetbench compare one-edge-clamped --model exec:docs/strip.sh
jq -e '
  if (.load + .actuator != [] or ([.support[] | {edge, kind}] != [{edge: "x0", kind: "clamped"}]))
  then "knows a sheet clamped at x0 under its own weight, no more\n" | halt_error(2) else . end |
  .sheet as $s | (.material.young * pow($s.thickness; 3) / 12) as $rigidity | $s.length_x as $l |
  (.material.density * $s.thickness * .gravity.acceleration[2] / (24 * $rigidity)) as $q |
  {status: "converged", probes: (.probes | map_values(
    .[0] as $x | [0, 0, $q * $x * $x * (6 * $l * $l - 4 * $l * $x + $x * $x)]))}'
