"""Studies of the models, run from a checkout by `sheetbench study NAME`.

A study is a folder of this package with a module `command`, whose function `command` has the study's options
as its parameters. Nothing here is installed; the packages import a study by its name alone. Results are
kept in `results`, and `pages` makes the documentation's tables of them.
"""

STUDIES = {
    "codes": "other people's codes with numbers in use and with ours, and our models: error and time",
    "master-curves": "the heavy cantilever and lateral buckling, without units: lattices and shells",
    "promises": "error bars, expected errors and advice beside the errors that there are",
    "reference-set": "the reference set of score, computed anew",
    "reproduction": "Habibi et al. reproduced: errors, tables, settling run, the nearest sheets",
    "rubber": "laws and constants of measured rubbers, and the stretch from which a linear lattice is off",
    "stability": "where each model holds, degrades, refuses or breaks, on published and extreme scenes",
    "transfer": "every calibration on scenes that it was not made on, and on drawn sheets, by grid",
}
