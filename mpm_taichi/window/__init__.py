"""The window of `view`: a simulation that is watched while it is computed.

- `playback`   the simulation: start, stop, step, reset, step by stages, and what there is to show:
               `energies`, and the `scales` of the colors
- `looks`      what the user has chosen to see: color, grid, log, the picked particle
- `viewpoint`  pan, zoom, orbit
- `desk`       these three, which all controls act on; `album` keeps the pictures that are asked for
- `canvas`     what they look like, as one picture; `cell_numbers`, `chart` and `sketch` draw parts
- `panel`      buttons, sliders, the log (`log`) and the numbers of a stage (`stage_notes`)
- `gestures`   keys and the mouse
- `layout`     where all of this is
- `screen`     the window itself, the one part that needs Vulkan and a display
- `live`       puts them together
"""
