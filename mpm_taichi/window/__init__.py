"""The window of `view`: a simulation that is watched while it is computed.

- `playback`   the simulation: start, stop, step, reset, step by stages, and what it shows
- `looks`      what the user has chosen to see: color, grid, log, the picked particle
- `viewpoint`  pan, zoom, orbit
- `canvas`     all of it as one picture; `cell_numbers`, `chart` and `sketch` draw parts
- `panel`      buttons, sliders, the log (`log`) and the numbers of a stage (`stage_notes`)
- `gestures`   keys and the mouse
- `screen`     the window itself, the one part that needs Vulkan and a display
- `live`       puts them together
"""
