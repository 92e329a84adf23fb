"""Array jobs for HTCondor, as its own reader of submit files takes them: a dry run, without a pool. Skipped, saying so, where
HTCondor's package for Python is not installed."""
import os
import pathlib
import shlex
import subprocess

import pytest

from conftest import UMOV

os.environ.setdefault("CONDOR_CONFIG", "/dev/null")  # no pool is looked for
htcondor = pytest.importorskip("htcondor", reason="HTCondor's Python package is not installed: its submit files are not tested")


def words_of(arguments):
    """HTCondor's own form of a job's arguments: separated by blanks, in single quotes where they hold some, a quote doubled."""
    words, word, is_quoted, k = [], None, False, 0
    while k < len(arguments):
        c = arguments[k]
        if c == "'" and is_quoted and arguments[k + 1:k + 2] == "'":
            word += c
            k += 1
        elif c == "'":
            is_quoted, word = not is_quoted, word or ""
        elif c == " " and not is_quoted:
            words += [word] if word is not None else []
            word = None
        else:
            word = (word or "") + c
        k += 1
    return words + ([word] if word is not None else [])


@pytest.mark.parametrize("folder", ["job", "the captain's \"job\""])
def test_tasks_of_a_submit_file_do_the_whole_job(umov, scenario, tmp_path, folder):
    """What HTCondor would start, started here: the plain bytes."""
    command = ["signature", scenario(), "--poses", 200, "--phase", "60", "--accuracy", "0.05"]
    assert umov(*command, "-o", "plain.csv").code == 0
    written = umov("scale", "script", "condor", "--tasks", 3, "--threads", 2, "--memory-mb", 700, "--per-shard", 20, "-o", "job.sub",
                   folder, *command)
    assert written.code == 0, written.err
    submit = htcondor.Submit((tmp_path / "job.sub").read_text())
    tasks = list(submit.jobs(clusterid=7, owner="nobody"))
    assert [task["ProcId"] for task in tasks] == [0, 1, 2]
    for task in tasks:
        assert (task["RequestCpus"], task["RequestMemory"], task["ShouldTransferFiles"]) == (2, 700, "NO")
        assert not task["TransferExecutable"] and pathlib.Path(task["Cmd"]).samefile(UMOV)
        words = words_of(task["Arguments"])
        # of what HTCondor gives, a tenth is left to the program itself
        assert words == ["scale", "run", str(tmp_path / folder), "--part", f"{task['ProcId']}/3", "--threads", "2", "--memory-mb", "630", "-q"]
        with open(task["Out"], "w") as out, open(task["Err"], "w") as err:  # the folder of both is there
            done = subprocess.run([task["Cmd"], *words], cwd="/", stdout=out, stderr=err)
        assert done.returncode == 0, shlex.join(words)
    assert umov("scale", "merge", folder, "-o", "merged.csv").code == 0
    assert (tmp_path / "merged.csv").read_bytes() == (tmp_path / "plain.csv").read_bytes()
