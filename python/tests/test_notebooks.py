"""In a Jupyter kernel: the pages of the gallery, Ctrl-C, progress, and what objects look like."""
import os
import re
import sys
import time

import nbformat
import pytest
from conftest import EXAMPLES, ROOT
from jupyter_client.manager import KernelManager

sys.path.insert(0, str(ROOT / "tools/site"))
import gallery  # noqa: E402


@pytest.mark.parametrize("page", gallery.pages(), ids=lambda path: path.stem)
def test_page_runs(page):
    """As the notebook that the site gives away, which then holds the figures that the page shows."""
    made = gallery.run(page)
    assert made["cells"][0]["source"].startswith("# ")
    assert gallery.pictures(made) and all(png.startswith(b"\x89PNG") for png in gallery.pictures(made))
    written = gallery.file_of(made)
    nbformat.validate(nbformat.reads(written, as_version=4))
    assert str(ROOT) not in written  # a page of anybody's machine
    assert not any(output["output_type"] == "error" for cell in made["cells"] for output in cell.get("outputs", ()))


class Kernel:
    """A kernel as Jupyter keeps it."""

    def __init__(self, folder):
        self.manager = KernelManager(kernel_name="python3")
        self.manager.start_kernel(env={**os.environ, **gallery.SETTINGS}, cwd=str(folder),
                                  extra_arguments=["--IPKernelApp.log_level=40"])
        self.client = self.manager.client()
        self.client.start_channels()
        self.client.wait_for_ready(timeout=60)
        self.run("import umov")

    def run(self, code, interrupt_at=None):
        """Outputs of a cell; interrupted once it printed the words `interrupt_at`. The last is the reply of the cell."""
        asked, out, pressed = self.client.execute(code), [], None
        while True:
            message = self.client.get_iopub_msg(timeout=120)
            if message["parent_header"].get("msg_id") != asked:
                continue
            kind, content = message["msg_type"], message["content"]
            if kind in ("stream", "display_data", "execute_result", "error"):
                out.append(content)
            if pressed is None and interrupt_at is not None and interrupt_at in content.get("text", ""):
                pressed = time.perf_counter()
                self.manager.interrupt_kernel()
            if kind == "status" and content["execution_state"] == "idle":
                break
        if pressed is not None:
            print(f"the cell ended {time.perf_counter() - pressed:.3f} s after the interrupt")
        return out

    def value(self, code):
        """What a cell shows of its last line."""
        return next(one["data"] for one in self.run(code) if "data" in one)

    def close(self):
        self.client.stop_channels()
        self.manager.shutdown_kernel(now=True)


@pytest.fixture(scope="module")
def kernel(tmp_path_factory):
    made = Kernel(tmp_path_factory.mktemp("kernel"))
    yield made
    made.close()


LONG = {"render.method": "rays", "time.step_s": 0.02, "time.start": "2018-01-21T05:07:00Z",
        "time.stop": "2018-01-21T05:14:00Z"}


def test_the_stop_button_ends_a_cell_and_leaves_what_is_done(kernel):
    told = kernel.run(f"""
        seen = []
        def look(what, done, total):
            if done > 0 and not any(seen):
                print("under way", flush=True)
            seen.append(done)
        try:
            umov.run({str(EXAMPLES / "hst_maui.toml")!r}, set={LONG!r}, progress=look)
        except umov.Interrupted as caught:
            part = caught.partial
            raise
        """, interrupt_at="under way")
    assert told[-1]["ename"] == "Interrupted"
    assert kernel.value("part.is_partial, len(part) > 0")["text/plain"] == "(True, True)"
    assert kernel.value("umov.Engine(part.scenario, method='masks').evaluate([0, 0, 1], [0, 1, 1]).shape")["text/plain"] == "(3, 4)"


def test_progress_is_a_bar(kernel):
    told = kernel.run(f"_ = umov.run({str(EXAMPLES / 'hst_maui.toml')!r}, set={{'time.step_s': 20}}, progress=True)")
    text = "".join(one.get("text", "") for one in told)
    assert "100%" in text and "Warning" not in text, text


def test_objects_show_themselves(kernel):
    kernel.run(f"""
        curve = umov.run({str(EXAMPLES / "hst_maui.toml")!r}, set={{"time.step_s": 30}})
        hst = umov.Satellite(mesh=umov.example("hst.obj"), unit="m", up="+Z", materials="film_silvered", name="HST")
        """)
    assert "data:image/png" in kernel.value("curve")["text/html"] and "20580-" in kernel.value("curve")["text/html"]
    assert "data:image/png" in kernel.value("hst")["text/html"]
    assert "<table" in kernel.value("umov.materials()")["text/html"]
    picture = kernel.value("umov.render(hst, sun=[1, 1, 1], observer=[0, 1, 1], side=64, samples=1)")
    assert picture["image/png"].startswith("iVBOR")  # base64 of the PNG signature


def test_figures_stand_below_their_cell_once(kernel):
    told = kernel.run("import matplotlib.pyplot as plt\ncurve.plot()\nplt.show()")
    assert [list(one["data"]) for one in told if "image/png" in one.get("data", {})] == [["text/plain", "image/png"]]


def test_errors_are_short_and_have_their_text(kernel):
    told = kernel.run("umov.Material('paper_gold')")[-1]
    assert told["ename"] == "InputError" and "Did you mean" in told["evalue"]


def test_ipython_completes_names_and_shows_docstrings(kernel):
    kernel.client.complete("umov.Sat")
    while (reply := kernel.client.get_shell_msg(timeout=60))["msg_type"] != "complete_reply":
        pass
    assert "umov.Satellite" in reply["content"]["matches"] or "Satellite" in reply["content"]["matches"]
    kernel.client.inspect("umov.passes")
    while (reply := kernel.client.get_shell_msg(timeout=60))["msg_type"] != "inspect_reply":
        pass
    assert "Passes over a site" in re.sub(r"\x1b\[[0-9;]*m", "", reply["content"]["data"]["text/plain"])
