"""The numbers that the search for an equilibrium goes by."""

REFINE_BELOW = 1e-5  # residual, relative to the forces, at which corrections turn to the true tangent
RESIDUAL_TOLERANCE = 1e-11  # residual, relative to the forces, that counts as equilibrium
IDLE_CORRECTION = 1e-9  # of the sheet's longer side: what an idle correction may move
REUSE_FACTORS_WITHIN = 1e-6  # of the sheet's longer side: how far from where they were made factors serve
STALE_FACTORS_ABOVE = 0.1  # of a residual: factors whose correction leaves more are too old
FIRST_REACH = 0.4  # farthest predicted displacement of a first step, in sides of the sheet
SHORTEST_STEP, SHORTEST_REACH = 2.0**-12, 5e-4  # a step that fails is the last below this share of the load,
# and this predicted displacement in sides of the sheet: half of BRANCHING
FACTORISATIONS = 2000  # of one path
LENGTHEN_UP_TO = 7  # factorisations of a load step after which the next one may reach farther
CORRECTIONS = 14  # of one load step
REFINEMENTS = 6  # factorisations with the true tangent
FARTHEST = 4.0  # of the sheet's longer side: what one correction may move
LONGEST_REFINEMENT = 0.1  # of the sheet's longer side: what one with the true tangent may move
DOUBTFUL = 30  # factorisations from which on a load step may have jumped over a fold
DEARER = 4  # times as many may be taken to see whether one has
CAREFUL_REACH = 0.1  # predicted displacement of the first careful load step, in sides of the sheet
CONTINUOUS, MISS = 0.5, 0.05  # of a careful step's prediction, and of the side: what its end may be off it
SAFE, GROWTH = 0.8, 4.0  # of what the last miss lets the next careful step go; of the last one's length
BRANCHING = 1e-3  # careful steps [sides of the sheet] so short may cross a bifurcation
COLLAPSED = 1e-6  # of a link's rest length
