"""umov render: pictures in files."""
import math
import struct
import zlib

import matplotlib
import matplotlib.image
import numpy as np

from conftest import ROOT, processor_s_of_children

SCENE = """umov = 1
[[object]]
name = "sphere"
mesh = { file = "sphere.obj", unit = "m", up = "+Z", normals = "smooth" }
[object.materials]
default = "paper_al"
[bands]
set = "paper_rgb"
"""


def scene(umov, tmp_path):
    assert umov("mesh", "make", "sphere", "--facets", "2000", "-o", "sphere.obj").code == 0
    (tmp_path / "scene.toml").write_text(SCENE)


def chunks(png):
    """Types and data of the chunks of a PNG, each with a right checksum."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    out, at = [], 8
    while at < len(png):
        (length,) = struct.unpack(">I", png[at:at + 4])
        kind, data = png[at + 4:at + 8], png[at + 8:at + 8 + length]
        assert struct.unpack(">I", png[at + 8 + length:at + 12 + length])[0] == zlib.crc32(kind + data)
        out.append((kind.decode(), data))
        at += 12 + length
    return out


def test_picture_from_directions(umov, tmp_path):
    scene(umov, tmp_path)
    for shade in ("I", "p", "pa", "material", "colour"):
        done = umov("render", "scene.toml", "--sun", 1, 0, 0, "--observer", 0, 1, 0, "--size", 64,
                    "--shade", shade, "-o", f"{shade}.png")
        assert done.code == 0, done.err
        kinds = dict(chunks((tmp_path / f"{shade}.png").read_bytes()))
        assert struct.unpack(">II", kinds["IHDR"][:8]) == (64, 64)
    pictures = {(tmp_path / f"{shade}.png").read_bytes() for shade in ("I", "p", "pa", "material")}
    assert len(pictures) == 4


def test_a_picture_of_p_has_the_bar_of_its_colours(umov, tmp_path):
    scene(umov, tmp_path)
    for shade in ("I", "p"):
        done = umov("render", "scene.toml", "--sun", 1, 0, 0, "--observer", 0, 1, 0, "--size", 400,
                    "--shade", shade, "-o", f"{shade}.png")
        assert done.code == 0, done.err
    bar = matplotlib.image.imread(tmp_path / "p.png")[300:388, 10, :3]
    # viridis by its own maker at p = 0, 1/8, ... 1 and straight lines between (polarization_scale); 8 bits of colour.
    stops, value = np.linspace(0, 1, 9), 1 - (np.arange(88) + 0.5) / 88
    wanted = np.transpose([np.interp(value, stops, channel) for channel in matplotlib.colormaps["viridis"](stops)[:, :3].T])
    assert np.abs(bar - wanted).max() < 0.006
    assert (np.ptp(matplotlib.image.imread(tmp_path / "I.png")[300:388, 10, :3], axis=0) == 0).all()


def test_animation_of_a_pass(umov, tmp_path):
    done = umov("render", ROOT / "examples/hst_maui.toml", "--frames", 5, "--size", 48, "--set", "time.step_s=20",
                "-o", "pass.png")
    assert done.code == 0, done.err
    found = chunks((tmp_path / "pass.png").read_bytes())
    kinds = [kind for kind, _ in found]
    assert struct.unpack(">II", dict(found)["acTL"]) == (5, 0)
    assert kinds.count("fcTL") == 5
    assert kinds.index("acTL") < kinds.index("IDAT")
    # Sequence numbers of fcTL and fdAT run from 0 without a gap (W3C PNG third edition, 11.3.6).
    sequence = [struct.unpack(">I", data[:4])[0] for kind, data in found if kind in ("fcTL", "fdAT")]
    assert sequence == list(range(len(sequence)))



def test_frames_in_files_of_their_own(umov, tmp_path):
    """A part of them has the bytes of the whole; pictures share the exposure of the movie."""
    pass_of = ["render", ROOT / "examples/hst_maui.toml", "--frames", 4, "--size", 32, "--set", "time.step_s=20"]
    for folder, part in (("whole", []), ("part", ["--range", "1:2"]), ("share", ["--shard", "1/2"])):
        (tmp_path / folder).mkdir()
        done = umov(*pass_of, *part, "-o", f"{folder}/f_###.exr")
        assert done.code == 0, done.err
    names = {folder: sorted(path.name for path in (tmp_path / folder).iterdir()) for folder in ("whole", "part", "share")}
    assert names == {"whole": [f"f_{k:03d}.exr" for k in range(4)], "part": ["f_001.exr", "f_002.exr"],
                     "share": ["f_002.exr", "f_003.exr"]}
    for folder in ("part", "share"):
        for name in names[folder]:
            assert (tmp_path / folder / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
    assert umov(*pass_of, "-o", "f#.png").code == 0
    assert umov(*pass_of, "-o", "movie.png").code == 0
    movie = b"".join(data for kind, data in chunks((tmp_path / "movie.png").read_bytes()) if kind == "IDAT")
    assert movie == b"".join(data for kind, data in chunks((tmp_path / "f0.png").read_bytes()) if kind == "IDAT")
    for part, name, why in ((["--range", "3:2"], "f_#.exr", "frames"), (["--range", "0:1"], "f_#.png", "exposure"),
                            ([], "f.exr", "-o pass_###.exr")):
        done = umov(*pass_of, *part, "-o", name)
        assert done.code == 2 and why in done.err, done.err


def test_exr_sums_to_the_signature(umov, tmp_path):
    """Radiance summed over the picture is the intensity of `umov signature`, in the picture's axes."""
    import OpenEXR  # the format's own reader, of PyPI
    scene(umov, tmp_path)
    (tmp_path / "g.csv").write_text("sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n1,0,0,0.3,1,0\n")
    assert umov("signature", "scene.toml", "--geometry", "g.csv", "--set", "render.sun=point", "-o", "s.csv").code == 0
    done = umov("render", "scene.toml", "--sun", 1, 0, 0, "--observer", 0.3, 1, 0, "--size", 400, "--samples", 4,
                "--half-width", 1.02, "--set", "render.sun=point", "-o", "s.exr")
    assert done.code == 0, done.err
    from conftest import read_csv
    with OpenEXR.File(str(tmp_path / "s.exr"), separate_channels=True) as file:
        channels = {name: channel.pixels for name, channel in file.channels().items()}
        assert file.header()["POLCCONV"] == "IAU"
    pixel = (2 * 1.02 / 400) ** 2
    for row in read_csv(tmp_path / "s.csv"):
        i, q, u = (float(channels[f"{row['band']}.{name}"].sum()) * pixel for name in "IQU")
        # 1600 x 1600 rays over a sphere of 2000 facets, steep at its glint: some parts in a thousand
        assert abs(i / float(row["intensity"]) - 1) < 0.01
        # Sun and observer lie in the plane z = 0 and +z is up: +Q of the scattering plane is up.
        assert abs(q / i - float(row["q_scat"])) < 1e-4
        assert abs(u / i) < 1e-4


def test_exr_with_light_between_surfaces(umov, tmp_path):
    """Two rough plates at a right angle, up to three surfaces: the picture again sums to the signature."""
    import OpenEXR
    from conftest import read_csv
    (tmp_path / "sphere.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\nf 1 2 3\nf 1 3 4\nf 1 4 6\nf 1 6 5\n")
    (tmp_path / "scene.toml").write_text(
        SCENE.replace('normals = "smooth" ', "").replace('up = "+Z", ', 'up = "+Z" ').replace("paper_al", "m")
        + '[material.m]\nindex = "Au_Johnson"\ndistribution = { model = "ggx", alpha = 0.3 }\n'
        + '[render]\nbounces = 3\nsun = "point"\naccuracy = 0.003\n')
    (tmp_path / "g.csv").write_text("sun_x,sun_y,sun_z,obs_x,obs_y,obs_z\n1,0.3,0.5,0.6,-0.2,1\n")
    done = umov("signature", "scene.toml", "--geometry", "g.csv", "-o", "s.csv")
    assert done.code == 0, done.err
    one = ["--sun", 1, 0.3, 0.5, "--observer", 0.6, -0.2, 1, "--size", 200, "--samples", 3, "--half-width", 1]
    done = umov("render", "scene.toml", *one, "-o", "s.exr")
    assert done.code == 0, done.err
    with OpenEXR.File(str(tmp_path / "s.exr"), separate_channels=True) as file:
        channels = {name: channel.pixels for name, channel in file.channels().items()}
        assert "up to 3 surfaces" in file.header()["unit"]
    pixel = (2 * 1 / 200) ** 2
    for row in read_csv(tmp_path / "s.csv"):
        i, q, u, v = (float(channels[f"{row['band']}.{name}"].sum()) * pixel for name in "IQUV")
        whole = float(row["intensity"])
        assert abs(i / whole - 1) < 0.01
        p = math.hypot(float(row["stokes_q"]), float(row["stokes_u"]))
        assert abs(math.hypot(q, u) - p) < 0.01 * whole  # the axes of a picture are others
        assert abs(v - float(row["stokes_v"])) < 0.005 * whole


def test_what_cannot_be_drawn_is_told(umov, tmp_path):
    scene(umov, tmp_path)
    done = umov("render", "scene.toml", "-o", "x.png")
    assert done.code == 3 and "orbit" in done.err
    done = umov("render", "scene.toml", "--sun", 1, 0, 0, "-o", "x.png")
    assert done.code == 2 and "--observer" in done.err
    done = umov("render", "scene.toml", "--sun", 1, 0, 0, "--observer", 0, 0, 1, "-o", "x.png")
    assert done.code == 2 and "--up" in done.err
    done = umov("render", "scene.toml", "--sun", 1, 0, 0, "--observer", 0, 1, 0, "-o", "x.jpg")
    assert done.code == 2 and ".png" in done.err
    done = umov("render", "scene.toml", "--sun", 1, 0, 0, "--observer", 0, 1, 0, "--band", "nm:500", "-o", "x.png")
    assert done.code == 2 and "nm:550" in done.err
    done = umov("render", ROOT / "examples/hst_maui.toml", "--time", "2018-01-21T05:11:00", "-o", "x.png")
    assert done.code == 3 or done.code == 2
    assert not list(tmp_path.glob("x.*"))


def test_elements_are_judged_at_the_time_that_is_asked_for(umov, tmp_path):
    """As `umov run` judges its span. The elements of the example are of 2018-01-20T10:33:30Z: 4383 days to 2030-01-20,
    less 19.44."""
    example = ROOT / "examples/hst_maui.toml"
    asked = ["render", example, "--time", "2030-01-01T00:00:00Z", "--size", 16, "--samples", 1, "-o", "y.png"]
    done = umov(*asked)
    assert done.code == 3 and "4363.6 d from the span" in done.err and "--allow-old-elements" in done.err, done.err
    assert not (tmp_path / "y.png").exists()
    assert umov(*asked, "--allow-old-elements").code == 0
    # The span of the scenario is not asked for: it may lie where the elements are of no use.
    far = ["--set", "time.start=2030-01-01T00:00:00Z", "--set", "time.stop=2030-01-01T01:00:00Z"]
    done = umov("render", example, "--time", "2018-01-21T05:11:00Z", *far, "--size", 16, "--samples", 1, "-o", "near.png")
    assert done.code == 0 and "warning" not in done.err, done.err
    done = umov("render", example, "--time", "2018-01-21T05:11:00Z", "--size", 16, "--samples", 1, "-o", "same.png")
    assert done.code == 0 and (tmp_path / "near.png").read_bytes() == (tmp_path / "same.png").read_bytes()


def test_what_nobody_would_see_at_the_time_is_told(umov, tmp_path):
    """Sunlit share and altitude are those of `umov orbit ephemeris`."""
    from conftest import read_csv
    told = {}
    for time in ("2018-01-21T05:11:00Z", "2018-01-21T12:00:00Z", "2018-01-21T12:10:00Z", "2018-01-21T13:50:00Z"):
        done = umov("orbit", "ephemeris", "--orbit", ROOT / "data/tle/hst.tle", "--norad", 20580, "--lat-deg", 20.7083,
                    "--lon-deg", -156.2578, "--alt-m", 3058, "--start", time, "--stop", time, "--step-s", 1, "-o", "e.csv")
        assert done.code == 0, done.err
        row, = read_csv(tmp_path / "e.csv")
        done = umov("render", ROOT / "examples/hst_maui.toml", "--time", time, "--size", 16, "--samples", 1, "-o", "x.png")
        assert done.code == 0, done.err
        share, altitude = float(row["sunlit"]), float(row["alt"])
        told[time] = (share < 1, altitude < 0)
        assert ("in the Earth's shadow" in done.err) == (share == 0), done.err
        assert ("below the horizon" in done.err) == (altitude < 0), done.err
        assert (f"(sunlit share {share:.3g}, altitude {altitude:.1f} deg)" in done.err) == any(told[time]), done.err
        assert ("warning" in done.err) == any(told[time]), done.err
    assert {(False, False), (True, True), (False, True)} <= set(told.values()), told


def test_options_that_would_change_nothing_are_refused(umov, scenario, tmp_path):
    time, pair = ("--time", "2018-01-21T05:11:00Z"), ("--sun", 1, 0, 0, "--observer", 0, 1, 0)
    for options, why in (((*time, "--frames", 3), "--frames"), ((*time, "--up", 0, 1, 0), "--observer"),
                         (("--up", 0, 1, 0), "--observer"), ((*time, "--fps", 5), "--frames N"),
                         ((*pair, "--fps", 5), "--frames N"), ((*pair, "--paths", 4), "render.bounces")):
        done = umov("render", scenario(), *options, "--size", 16, "--samples", 1, "-o", "x.png")
        assert done.code == 2 and why in done.err, (options, done.err)
    done = umov("render", scenario(), "--frames", 2, "--fps", 5, "--size", 16, "-o", "f_#.png")
    assert done.code == 2 and "without #" in done.err, done.err
    for options, name, why in ((("--shade", "p"), "x.exr", "--shade"), (("--band", "nm:550"), "x.exr", "--band"),
                               (("--shade", "colour", "--band", "nm:550"), "x.png", "--band")):
        done = umov("render", scenario(), *pair, *options, "--size", 16, "-o", name)
        assert done.code == 2 and why in done.err, (options, done.err)
    assert not [*tmp_path.glob("*.png"), *tmp_path.glob("*.exr")]
    for options in ((*pair, "--up", 0, 0, 1), (*pair, "--paths", 4, "--set", "render.bounces=2"),
                    ("--frames", 2, "--fps", 5)):
        done = umov("render", scenario(), *options, "--size", 16, "--samples", 1, "-o", "x.png")
        assert done.code == 0, done.err


def cpu_of(umov, material, tmp_path):
    before = processor_s_of_children()
    (tmp_path / "s.toml").write_text(SCENE.replace("paper_al", material).replace('"paper_rgb"', '["Bessell.V"]'))
    done = umov("render", "s.toml", "--sun", 1, 0, 0, "--observer", 0.5, 0.8, 0, "--size", 128, "-o", f"{material}.png")
    assert done.code == 0, done.err
    return processor_s_of_children() - before


def test_films_cost_no_more_for_each_point_of_a_picture(umov, tmp_path):
    """A stack of films at 16 wavelengths of a band was computed for every point: thirty times a metal's picture."""
    scene(umov, tmp_path)
    assert cpu_of(umov, "cell_silicon", tmp_path) < 5 * cpu_of(umov, "gold", tmp_path)
