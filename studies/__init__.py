"""The laboratory: studies of the models, run from a checkout by `sheetbench study NAME`.

A study is a folder of this package with a module `command`, whose function `command` has the study's options
as its parameters. Nothing here is installed; the packages import none of it but by that name.
"""

STUDIES = {
    "advisor": "the advisor on scenes drawn at random: is the tolerance kept, is the choice the cheapest?",
    "central": "the table of the calibration central, trained anew",
    "coverage": "how often the references' error bars hold the error, on drawn scenes",
    "drawn": "lattice against shell on sheets with outlines, holes, fibres: errors and orders",
    "expected-errors": "the expected error of a lattice's grid on a hundred scenes, beside the true one",
    "leaderboard": "what models get wrong on statics and curves of the reference set, and their times",
    "master-curves": "the heavy cantilever and lateral buckling, without units: lattices and shells",
    "peers": "our models beside other people's codes, in one run",
    "reference-set": "the reference set of suite and score, computed anew",
    "rubber": "laws and constants of measured rubbers, and the stretch from which a linear lattice is off",
    "simulators": "other simulators with what is exported for them",
    "stability": "where each solver holds, degrades, refuses or breaks: eight published maps",
    "trials": "other codes with the numbers people use and with ours: error and time",
    "transfer": "every calibration on scenes that it was not made on, as the grid is refined",
}
