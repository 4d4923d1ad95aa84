"""Messages of the physics, with the options that help."""

from tests.cli.runs import run


def test_an_atmosphere_too_thick_to_be_solved_names_the_methods_that_are_not(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    thick = ("--preset", "mars", "--set", "dust.optical_depth=200", "--size", "16x8")
    status, output, errors = run("render", *thick, "-q")
    assert (status, output) == (1, "")
    (line,) = errors.splitlines()
    assert line.startswith("skybake: multiple scattering: optical depth of the atmosphere ")
    assert line.endswith("; use probe --method reference")
    assert list(tmp_path.iterdir()) == []
