"""What the tests share: a renderer, made-up Gaussians, and the program."""

import os
import pathlib
import subprocess

import pytest

import rara

SIZE = (64, 48)


@pytest.fixture(scope="session")
def renderer():
    return rara.Renderer(os.environ.get("RARA_TEST_DEVICE"))


@pytest.fixture(scope="session")
def gaussians():
    return rara.generate("general", 500, seed=3)


@pytest.fixture(scope="session")
def program():
    """Runs the program `rara` and returns what it prints."""
    path = pathlib.Path(os.environ["RARA_PROGRAM"])

    def run(*arguments):
        done = subprocess.run([path, *map(str, arguments)], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run
