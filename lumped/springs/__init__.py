"""Springs and dampers, one kind a file: links, areas, strains of cells.

Their compiled kernels are kept in the user's cache, unless NUMBA_CACHE_DIR names another place: numba would
keep them inside the installed package, where uninstalling leaves them behind.
"""

import os

from platformdirs import user_cache_path

os.environ.setdefault("NUMBA_CACHE_DIR", str(user_cache_path("sheetbench") / "numba"))  # numba reads it once
