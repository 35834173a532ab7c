"""Tell what works on this computer: packages, libraries, backends, window, memory."""

import json
import sys


def add(parser) -> None:
    parser.add_argument("--json", action="store_true", help="as JSON")


def execute(options) -> int:
    from ..doctor import examine, table

    if not options.json:
        print("trying each backend in a process of its own ...", file=sys.stderr)
    found = examine()
    print(json.dumps(found, indent=2) if options.json else table(found))
    return 0 if "f64" in found["backends"]["cpu"]["works"] else 1
