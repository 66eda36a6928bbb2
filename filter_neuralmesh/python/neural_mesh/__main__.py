# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""The command neural-mesh: a cloud in, a mesh out."""

import argparse
import sys


def value_of(text):
    """A parameter's value: true or false, an integer, a number, else the text."""
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def settings_of(words):
    settings = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not equals:
            raise SystemExit(f"neural-mesh: '{word}' is not of the form name=value, such as target_vertices=5000.")
        settings[name] = value_of(value)
    return settings


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="neural-mesh", description="Reconstructs the surface of a point cloud.")
    parser.add_argument("cloud", help="a file of points or a mesh, in any format of pymeshlab")
    parser.add_argument("mesh", help="the file to write, such as mesh.ply")
    parser.add_argument("settings", nargs="*", metavar="name=value", help="parameters of the filter, such as "
                        "target_vertices=5000")
    given = parser.parse_args(arguments)
    settings = settings_of(given.settings)
    try:
        import pymeshlab

        import neural_mesh
        meshes = pymeshlab.MeshSet(verbose=False)
        meshes.load_new_mesh(given.cloud)
        result = getattr(meshes, neural_mesh.FILTER)(**settings)
        can_keep_quality = given.mesh.lower().endswith(".ply")
        meshes.save_current_mesh(given.mesh, **({"save_vertex_quality": True} if can_keep_quality else {}))
    except ImportError as error:
        raise SystemExit(f"neural-mesh: {error}") from None
    except pymeshlab.PyMeshLabException as error:
        raise SystemExit(f"neural-mesh: {error}") from None
    print(" ".join(f"{key}={value:.6g}" for key, value in result.items()))


if __name__ == "__main__":
    sys.exit(main())
