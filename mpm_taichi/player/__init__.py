"""A recorded run as one HTML file that plays by itself: no network, no server, no library.

- `packing`     frames -> bytes of which deflate makes little
- `film`        a recording -> what the page is told, and its packed frames
- `stage_film`  the stages of steps, where they were recorded
- `page`        both, with the files of `template/`, -> the HTML"""

from .page import Player, player

__all__ = ["Player", "player"]
