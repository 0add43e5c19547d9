"""The geometrically nonlinear Reissner–Mindlin shell.

Its compiled kernels are kept in the user's cache, unless NUMBA_CACHE_DIR names another place.
"""

import os

from platformdirs import user_cache_path

os.environ.setdefault("NUMBA_CACHE_DIR", str(user_cache_path("sheetbench") / "numba"))  # numba reads it once
