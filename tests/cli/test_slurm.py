"""Array jobs on a real SLURM, started on this machine alone and without systemd. Skipped, saying why, where the
Debian packages slurm-wlm and munge are not installed or its daemons do not start."""
import os
import shutil
import signal
import socket
import subprocess
import sys
import time

import pytest

from conftest import ROOT


def configuration(folder, host):
    """One node, which is this machine; nothing listens but on the loopback."""
    memory_mb = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20 * 9 // 10
    return f"""ClusterName=umovtest
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort=26837
SlurmdPort=26838
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
KillWait=2
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} RealMemory={memory_mb} State=UNKNOWN
PartitionName=short Nodes={host} Default=YES MaxTime=01:00:00 State=UP
"""


@pytest.fixture(scope="module")
def slurm(tmp_path_factory):
    """Environment with SLURM_CONF of a SLURM that runs."""
    missing = [one for one in ("slurmctld", "slurmd", "sbatch", "munged") if not shutil.which(one)]
    if missing:
        pytest.skip(f"no SLURM here ({', '.join(missing)}): apt-get install slurm-wlm munge")
    if os.geteuid() != 0:
        pytest.skip("SLURM is started as root alone")
    folder, host = tmp_path_factory.mktemp("slurm"), socket.gethostname().split(".")[0]
    for part in ("state", "spool"):
        (folder / part).mkdir()
    for parent in [folder, *folder.parents][:4]:
        parent.chmod(0o755)  # munge's socket is refused below what others cannot enter
    (folder / "slurm.conf").write_text(configuration(folder, host))
    key = folder / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o400)
    environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}

    def call(*words):
        return subprocess.run(words, env=environment, capture_output=True, text=True, timeout=60)

    call("munged", "--force", f"--key-file={key}", f"--socket={folder}/munge.socket", f"--pid-file={folder}/munged.pid",
         f"--log-file={folder}/munged.log", f"--seed-file={folder}/munge.seed")
    call("slurmctld", "-f", str(folder / "slurm.conf"))
    call("slurmd", "-f", str(folder / "slurm.conf"))
    try:
        for _ in range(150):
            if "idle" in call("sinfo", "-h", "-o", "%T").stdout:
                break
            time.sleep(0.2)
        else:
            logs = "".join((folder / name).read_text()[-600:] for name in ("slurmctld.log", "slurmd.log", "munged.log")
                           if (folder / name).exists())
            pytest.skip(f"SLURM does not start here: {logs}")
        yield environment
    finally:
        for name in ("slurmd", "slurmctld", "munged"):
            if (folder / f"{name}.pid").exists():
                try:
                    os.kill(int((folder / f"{name}.pid").read_text()), signal.SIGTERM)
                except OSError:
                    pass  # it ended by itself


def test_an_array_job_gives_the_plain_bytes(slurm, umov, scenario, tmp_path):
    """The script as it is written; the second time it finds nothing to do."""
    command = ["signature", scenario(), "--poses", 400, "--phase", "60", "--visibility", "rays", "--accuracy", "0.05"]
    assert umov(*command, "-o", "plain.csv").code == 0
    written = umov("scale", "script", "slurm", "--tasks", 4, "--memory-mb", 500, "--per-shard", 40, "-o", "job.sbatch",
                   "job", *command)
    assert written.code == 0, written.err
    for _ in range(2):
        done = subprocess.run(["sbatch", "--wait", "job.sbatch"], env=slurm, cwd=tmp_path, capture_output=True,
                              text=True, timeout=240)
        logs = "".join(path.read_text() for path in (tmp_path / "job/log").iterdir())
        assert done.returncode == 0, done.stderr + logs
    assert umov("scale", "merge", "job", "-o", "merged.csv").code == 0
    assert (tmp_path / "merged.csv").read_bytes() == (tmp_path / "plain.csv").read_bytes()


BY_DASK = """
import sys
import dask_jobqueue
import umov
cluster = dask_jobqueue.SLURMCluster(cores=1, processes=1, memory="500MB", walltime="00:10:00", interface="lo", python=sys.executable,
                                     local_directory=".", log_directory="log", scheduler_options={"dashboard_address": "127.0.0.1:0"},
                                     job_script_prologue=["export PYTHONPATH=" + sys.argv[1]], death_timeout=60)
cluster.scale(jobs=2)
umov.scale.run(None, "job", cluster=cluster)
cluster.close()
"""


def test_a_dask_cluster_of_slurm_jobs_gives_the_plain_bytes(slurm, umov, scenario, tmp_path):
    """umov.scale takes the cluster as it is; its workers are jobs of SLURM."""
    pytest.importorskip("dask_jobqueue", reason="dask-jobqueue is not installed: SLURMCluster is not tested")
    command = ["signature", scenario(), "--poses", 400, "--phase", "60", "--visibility", "rays", "--accuracy", "0.05"]
    assert umov(*command, "-o", "plain.csv").code == 0
    assert umov("scale", "lock", "-q", "--per-shard", 40, "job", *command).code == 0
    package = str(ROOT / "build/release/python")
    done = subprocess.run([sys.executable, "-c", BY_DASK, package], env={**slurm, "PYTHONPATH": package}, cwd=tmp_path,
                          capture_output=True, text=True, timeout=240)
    logs = "".join(path.read_text()[-2000:] for path in (tmp_path / "log").glob("*"))
    assert done.returncode == 0, done.stderr + logs
    assert umov("scale", "merge", "job", "-o", "merged.csv").code == 0
    assert (tmp_path / "merged.csv").read_bytes() == (tmp_path / "plain.csv").read_bytes()
