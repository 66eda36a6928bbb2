# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The command neural-mesh: a cloud in, a mesh out, and its subcommands."""

import argparse
import importlib
import sys
import warnings
from pathlib import Path
from typing import Any, List, Optional

from neural_mesh import NeuralMeshWarning, reconstruct
from neural_mesh.clouds import CloudError
from neural_mesh.files import NotWhole, load, save
from neural_mesh.parameters import WrongUsage, check, line_of, settings_of

# A subcommand is the module of that name, with add_arguments(parser) and run(given), which returns the exit status.
SUBCOMMANDS = {
    "batch": "many clouds, with a manifest of what became of each",
    "stream": "a cloud that does not fit into memory",
}


def learn_one(given: argparse.Namespace) -> int:
    settings = settings_of(given.settings)
    check(settings)
    mesh = reconstruct(**load(Path(given.cloud)), **settings)
    save(mesh, Path(given.mesh))
    print(line_of(mesh.report))
    return 0


def arguments_of_one(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("cloud", help="a file of points or a mesh")
    parser.add_argument("mesh", help="the file to write, such as mesh.ply")
    parser.add_argument("settings", nargs="*", metavar="name=value", help="parameters of the filter, such as "
                        "target_vertices=5000")
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = "\n".join(["other forms, which explain themselves with --help:", *(
        f"  neural-mesh {name:8}{what}" for name, what in SUBCOMMANDS.items())])


def say_warnings() -> None:
    """Lets warnings of the filter be sentences, without the place of the call."""
    others = warnings.showwarning

    def show(message: Any, category: Any, *place: Any, **more: Any) -> None:
        if issubclass(category, NeuralMeshWarning):
            print(f"neural-mesh: {message}", file=sys.stderr)
        else:
            others(message, category, *place, **more)

    warnings.simplefilter("always", NeuralMeshWarning)
    warnings.showwarning = show


def main(arguments: Optional[List[str]] = None) -> int:
    words = sys.argv[1:] if arguments is None else arguments
    name = words[0] if words and words[0] in SUBCOMMANDS else ""
    if name and sys.platform != "linux":  # their processes, locks and limits are those of Linux
        print(f"neural-mesh: '{name}' runs on Linux only. Call neural_mesh.reconstruct() in a loop.", file=sys.stderr)
        return 2
    if name:
        module = importlib.import_module(f"neural_mesh.{name}")
        parser = argparse.ArgumentParser(prog=f"neural-mesh {name}", description=module.__doc__)
        module.add_arguments(parser)
        run = module.run
    else:
        parser = argparse.ArgumentParser(prog="neural-mesh", description="Reconstructs the surface of a point cloud.")
        arguments_of_one(parser)
        run = learn_one
    given = parser.parse_intermixed_args(words[1:] if name else words)
    say_warnings()
    try:
        return run(given)
    except WrongUsage as error:
        print(f"neural-mesh: {error}", file=sys.stderr)
        return 2
    except (CloudError, NotWhole, ValueError, MemoryError) as error:
        print(f"neural-mesh: {error or 'There is not enough memory.'}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("\nneural-mesh: stopped.", file=sys.stderr)
        return 130  # as shells report Ctrl-C


if __name__ == "__main__":
    sys.exit(main())
