"""Motion step after step: what an integrator gives a runner, and how long its steps are."""
