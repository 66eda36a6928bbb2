# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Which clouds a batch learns, and where each result is written."""

import contextlib
import glob
import os
import socket
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterable, Iterator, List, Tuple

from neural_mesh.parameters import Settings, WrongUsage

ASIDE = ".part"  # ends the name of a result until it is whole, before its extension

# The formats that pymeshlab 2025.7 loads.
FORMATS = ("3ds", "apts", "asc", "bre", "ctm", "dae", "e57", "es", "fbx", "glb", "gltf", "obj", "off", "pdb", "ply",
           "pts", "ptx", "qobj", "stl", "tri", "txt", "vmi", "wrl", "x3d", "x3dv", "xyz")


@dataclass(frozen=True)
class Job:
    """One cloud to learn."""
    input: str  # absolute
    output: str  # below the folder of results
    size: int  # bytes
    modified_ns: int
    settings: Settings


def can_load(file: Path) -> bool:
    return file.suffix[1:].lower() in FORMATS


def aside_of(result: Path, process: int) -> Path:
    """Where a process writes a result until it is whole: a hidden file, which no pattern finds. The machine is named
    for clusters whose machines share a disk."""
    machine = socket.gethostname().replace(".", "-")
    return result.with_name(f".{result.stem}.{machine}-{process}{ASIDE}{result.suffix}")


def remove_left(result: Path) -> None:
    """Removes what killed processes of this machine have left of a result."""
    before, after = aside_of(result, 0).name.rsplit(f"-0{ASIDE}", 1)
    for aside in result.parent.glob(f"{glob.escape(before)}-*{ASIDE}{glob.escape(after)}"):
        process = aside.name[len(before) + 1:-len(ASIDE + after)]
        if process.isdigit() and not Path(f"/proc/{process}").exists():
            remove(aside)


def remove(path: Path) -> None:
    """Removes a file if it is there and that is allowed."""
    with contextlib.suppress(OSError):
        path.unlink()


def remove_asides(out: Path, jobs: Iterable[Job]) -> None:
    """Removes what killed processes have left of the jobs' results."""
    results = {out / job.output for job in jobs}
    for folder in {result.parent for result in results}:
        for aside in folder.glob(f".*{ASIDE}.ply"):
            stem = aside.name[1:-len(f"{ASIDE}.ply")].rpartition(".")[0]
            if folder / f"{stem}.ply" in results:
                remove(aside)


def jobs_of(inputs: List[str], out: Path, settings: Settings) -> List[Job]:
    """The jobs of files, folders and patterns. A file in a folder keeps its path in that folder. Throws WrongUsage if a
    file is missing or not a cloud, or if a result would replace an input or another result."""
    clouds: Dict[str, Path] = {}  # by result
    for path, below in _files(inputs, out):
        output = below.with_suffix(".ply").as_posix()
        if clouds.setdefault(output, path) != path:
            raise WrongUsage(f"Both {clouds[output]} and {path} would become {output}: rename one, or use two folders "
                             "of results.")
    if not clouds:
        raise WrongUsage(f"There are no clouds in {', '.join(inputs)}.")
    taken = {path.resolve() for path in clouds.values()}
    for output, path in clouds.items():
        if (out / output).resolve() in taken:
            raise WrongUsage(f"The mesh of {path} would replace the input {out / output}: choose another folder of "
                             "results.")
    return [_job(path, output, settings) for output, path in clouds.items()]


def _job(path: Path, output: str, settings: Settings) -> Job:
    try:
        os.path.abspath(path).encode()
    except UnicodeEncodeError:
        raise WrongUsage(f"pymeshlab cannot load {str(path)!r}, whose name is not UTF-8: rename it.") from None
    try:
        state = path.stat()
    except OSError as error:  # such as a link to nothing
        raise WrongUsage(f"{path} cannot be read: {error.strerror}.") from None
    return Job(os.path.abspath(path), output, state.st_size, state.st_mtime_ns, settings)


def _files(inputs: List[str], out: Path) -> Iterator[Tuple[Path, Path]]:
    """Each file, and its path below the folder that was given, or its name."""
    for word in inputs:
        named = [word] if os.path.exists(word) else sorted(glob.glob(word, recursive=True))
        if not named:
            raise WrongUsage(f"There is no file or folder {word}.")
        for path in map(Path, named):
            if path.is_dir():
                yield from ((file, file.relative_to(path)) for file in _in_folder(path, out) if can_load(file))
            elif can_load(path):
                yield path, Path(path.name)
            else:
                raise WrongUsage(f"{path}: pymeshlab cannot load files of the kind '{path.suffix}'.")


def _refuse(error: OSError) -> None:
    raise WrongUsage(f"The folder {error.filename} cannot be read: {error.strerror}.")


def _in_folder(folder: Path, out: Path) -> Iterator[Path]:
    """The files at any depth, in a fixed order, without hidden ones and without the folder of results."""
    for place, folders, files in os.walk(folder, onerror=_refuse):
        folders[:] = sorted(name for name in folders
                            if not name.startswith(".") and (Path(place) / name).resolve() != out.resolve())
        yield from (Path(place) / name for name in sorted(files) if not name.startswith("."))
