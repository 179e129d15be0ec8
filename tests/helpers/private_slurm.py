#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a private Slurm on the loopback, to be tried and to be killed: several nodes on this machine, in one folder,
without root, systemd or limits by cgroups.

usage: private_slurm.py FOLDER [--nodes 4] [--cpus 1]     runs until Ctrl-C, and prints the command that a shell needs:
                                                          export SLURM_CONF=...

Needs slurmctld, slurmd, slurm-client and munge (Debian 12). It stops only processes that it started, and those that its
nodes run; it looks for no process by name.
"""
import argparse
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

CONFIGURATION = """ClusterName=lfprivate
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/log/slurmctld.log
SlurmdLogFile={folder}/log/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
PropagateResourceLimits=NONE
# Slurm believes the number of CPUs that a node states, whatever the machine has.
SlurmdParameters=config_overrides
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=2,sched_min_interval=200000
# A node that answers again is used again; a node that does not answer is soon marked as down.
ReturnToService=2
SlurmctldTimeout=10
SlurmdTimeout=10
MessageTimeout=5
TCPTimeout=2
BatchStartTimeout=10
KillWait=5
MinJobAge=300
{nodes}
PartitionName=main Nodes=n[1-{count}] Default=YES MaxTime=INFINITE State=UP
"""
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol", "scancel", "sinfo")


def find(program):
    """Finds a program, also in the folders of daemons, which are not in a user's PATH."""
    return shutil.which(program, path=os.environ.get("PATH", "") + ":/usr/sbin:/usr/local/sbin")


def missing():
    """Returns the programs and mounts that are needed and missing on this machine."""
    lacking = [program for program in PROGRAMS if find(program) is None]
    # slurmd needs this mount even if no resource is limited by cgroups.
    if not os.path.ismount("/sys/fs/cgroup"):
        lacking.append("cgroups mounted at /sys/fs/cgroup")
    return lacking


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def send(process, number):
    try:
        os.kill(process, number)
    except ProcessLookupError:
        pass


def stop_tree(process):
    """Stops a process, then its children and theirs. Returns all of them, each before its children. A process is
    stopped before its children are listed, because it could start another one."""
    send(process, signal.SIGSTOP)
    found = [process]
    for children in pathlib.Path("/proc", str(process), "task").glob("*/children"):
        try:
            words = children.read_text().split()
        except OSError:
            continue  # it has ended
        for child in words:
            found += stop_tree(int(child))
    return found


class PrivateSlurm:
    def __init__(self, folder: pathlib.Path, nodes=4, cpus=1, memory_mb=8000):
        self.folder = folder.resolve()
        self.count = nodes
        self.daemons = {}
        for name in ("log", "state", "munge", *(f"spool-n{k + 1}" for k in range(nodes))):
            (self.folder / name).mkdir(parents=True, mode=0o700)
        host = socket.gethostname().split(".")[0]
        ports = free_ports(nodes + 1)
        user = subprocess.run(["id", "-un"], capture_output=True, text=True, check=True)
        lines = [f"NodeName=n{k} NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[k]} CPUs={cpus} "
                 f"RealMemory={memory_mb} State=UNKNOWN" for k in range(1, nodes + 1)]
        self.configuration = self.folder / "slurm.conf"
        self.configuration.write_text(CONFIGURATION.format(
            host=host, ports=ports, user=user.stdout.strip(), folder=self.folder,
            nodes="\n".join(lines), count=nodes))
        self.environment = dict(os.environ, SLURM_CONF=str(self.configuration))
        try:
            self._start_all()
        except BaseException:
            self.stop()
            raise

    def _start(self, name, *command):
        with open(self.folder / "log" / f"{name}.out", "ab") as out:
            self.daemons[name] = subprocess.Popen(
                [find(command[0]), *map(str, command[1:])], stdin=subprocess.DEVNULL, stdout=out,
                stderr=out, env=self.environment, start_new_session=True)

    def _start_all(self):
        munge = self.folder / "munge"
        (munge / "key").write_bytes(os.urandom(1024))
        (munge / "key").chmod(0o400)
        self._start("munged", "munged", "--foreground", "--force", f"--socket={munge}/socket",
                    f"--key-file={munge}/key", f"--log-file={munge}/log",
                    f"--pid-file={munge}/pid", f"--seed-file={munge}/seed")
        self._wait("munged", lambda: (munge / "socket").exists())
        self._start("slurmctld", "slurmctld", "-D", "-i", "-f", self.configuration)
        for node in range(1, self.count + 1):
            self.start_node(node)
        self._wait("all nodes", lambda: self._idle_count() == self.count)

    def _wait(self, what, is_there, seconds=60):
        end = time.monotonic() + seconds
        while not is_there():
            if time.monotonic() > end:
                raise RuntimeError(f"{what}: not up after {seconds} s; see {self.folder}/log")
            time.sleep(0.1)

    def _idle_count(self):
        return self.call("sinfo", "-h", "-N", "-o", "%t").split().count("idle")

    def call(self, *command):
        """Returns the output of a program, even if the program fails."""
        return subprocess.run([find(command[0]), *map(str, command[1:])], capture_output=True,
                              text=True, env=self.environment, timeout=60).stdout

    def start_node(self, number):
        self._start(f"n{number}", "slurmd", "-D", "-f", self.configuration, "-N", f"n{number}")

    def _step_daemons(self, number):
        """Finds the step daemons of a node, which leave their slurmd but keep its log open."""
        log = str(self.folder / "log" / f"slurmd-n{number}.log")
        found = []
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if not (process / "cmdline").read_bytes().startswith(b"slurmstepd: "):
                    continue
                if any(os.readlink(file) == log for file in (process / "fd").iterdir()):
                    found.append(int(process.name))
            except OSError:
                continue  # a process of another user, or one that has ended
        return found

    def kill_node(self, number):
        """Kills the node and all its processes at once, like a power cut.

        All are stopped before one is killed. A process that sees its child die would otherwise start it again, and the
        new child, which nobody kills, would render a package on a node that is gone. The youngest are killed first,
        because the system continues a stopped process whose parent dies.
        """
        daemon = self.daemons.pop(f"n{number}", None)
        found = stop_tree(daemon.pid) if daemon is not None else []
        for step in self._step_daemons(number):
            found += stop_tree(step)
        for process in reversed(found):
            send(process, signal.SIGKILL)
        if daemon is not None:
            daemon.wait()

    def stop(self):
        for number in range(1, self.count + 1):
            self.kill_node(number)
        for name in ("slurmctld", "munged"):
            daemon = self.daemons.pop(name, None)
            if daemon is None:
                continue
            daemon.terminate()
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--nodes", type=int, default=4)
    parser.add_argument("--cpus", type=int, default=1, help="of each node")
    arguments = parser.parse_args()
    if missing():
        raise SystemExit(f"error: missing: {', '.join(missing())} "
                         "(apt-get install slurmctld slurmd slurm-client munge)")
    slurm = PrivateSlurm(arguments.folder, arguments.nodes, arguments.cpus)
    try:
        signals = {signal.SIGINT, signal.SIGTERM}
        signal.pthread_sigmask(signal.SIG_BLOCK, signals)
        print(f"export SLURM_CONF={slurm.configuration}", flush=True)
        signal.sigwait(signals)
    finally:
        slurm.stop()


if __name__ == "__main__":
    main()
