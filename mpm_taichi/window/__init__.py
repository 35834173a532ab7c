"""The window of `view`: a simulation that is watched while it is computed.

- `playback`   the simulation: start, stop, step, reset, and what it shows
- `looks`      what the user has chosen to see: color, grid, log, the picked particle
- `viewpoint`  pan, zoom, orbit
- `stage`      all of it as one picture, of which `cell_numbers` and `chart` draw parts
- `panel`      buttons, sliders and the log (`log`); `gestures`: keys and the mouse
- `screen`     the window itself, the one part that needs Vulkan and a display
- `live`       puts them together
"""
