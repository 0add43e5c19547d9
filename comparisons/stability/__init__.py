"""Where each model of a scene holds, degrades or refuses, as its sheet goes to extremes."""
