"""The command line: words to commands, faults to exit codes.

0 done, 1 the run failed, 2 bad input, 130 and 143 interrupted."""

import argparse
import difflib
import os
import sys

from . import __version__
from .commands import COMMANDS
from .errors import InputError, RunError


def main(arguments: list[str] | None = None) -> int:
    words = list(sys.argv[1:] if arguments is None else arguments)
    try:
        options = parse(words)
        return COMMANDS[options.command].execute(options)
    except InputError as error:
        print(error, file=sys.stderr)
        return 2
    except RunError as error:
        print(error, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # the reader of stdout, `head` say, has had enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except ImportError as error:
        return _missing_library(error)


def parse(words: list[str]) -> argparse.Namespace:
    """The options of a command; what is wrong ends the program or is an InputError."""
    top, parsers = parser()
    return top.parse_args(_with_command(words, parsers))


def parser() -> tuple[argparse.ArgumentParser, list[argparse.ArgumentParser]]:
    """That of all words, and those of the commands."""
    top = argparse.ArgumentParser(
        prog="mpm_taichi",
        description="Material Point Method simulator",
        epilog="`python -m mpm_taichi SCENE` is short for `python -m mpm_taichi run SCENE`.",
        allow_abbrev=False,
    )
    top.add_argument("--version", action="version", version=f"mpm_taichi {__version__}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, module in COMMANDS.items():
        text = " ".join((module.__doc__ or "").split("\n\n")[0].split())
        short = (text[0].lower() + text[1:]).removesuffix(".")
        module.add(commands.add_parser(name, help=short, description=text, allow_abbrev=False))
    return top, list(commands.choices.values())


def _with_command(words: list[str], parsers) -> list[str]:
    """`SCENE ...`, `--options SCENE` and `--resume RUN` become `run ...`."""
    first = _first_plain_word(words, parsers)
    if first is None:
        return ["run", *words] if "--resume" in words else words
    word = words[first]
    if word in COMMANDS:
        return [word, *words[:first], *words[first + 1 :]]
    if word.endswith((".yaml", ".yml")):
        return ["run", *words]
    close = difflib.get_close_matches(word, COMMANDS, 1)
    hint = f"; did you mean {close[0]!r}?" if close else f" ({', '.join(COMMANDS)})"
    raise InputError(f"{word!r} is neither a command nor a .yaml file{hint}")


def _first_plain_word(words: list[str], parsers) -> int | None:
    takes_value = {
        option
        for command in parsers
        for action in command._actions  # argparse has no public way to ask
        if action.nargs is None
        for option in action.option_strings
    }
    skip = False
    for number, word in enumerate(words):
        if skip:
            skip = False
        elif word.startswith("-") and len(word) > 1:
            last = word if word.startswith("--") else f"-{word[-1]}"  # of -qo DIR
            skip = last in takes_value
        else:
            return number
    return None


def _missing_library(error: ImportError) -> int:
    if "cannot open shared object file" not in str(error):
        raise error
    library = str(error).split(":")[0]
    print(
        f"Taichi needs the system library {library}, which is not installed.\n"
        "On Debian or Ubuntu:  sudo apt-get install libx11-6",
        file=sys.stderr,
    )
    return 2
