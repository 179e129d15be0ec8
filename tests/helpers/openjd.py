# SPDX-License-Identifier: Apache-2.0
"""Runs job templates of Open Job Description, for tests: a small interpreter of version 2023-09, written from its
specification. It checks the parts of a template that lfsubmit writes, and refuses all others."""
import pathlib
import re
import signal
import stat
import subprocess
import tempfile

import yaml

NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,63}")
REFERENCE = re.compile(r"\{\{\s*([A-Za-z_][\w.]*)\s*\}\}")
MOST_NOTIFY_SECONDS = 600


class TemplateFault(Exception):
    """A template is not as the specification says."""


def check(holds, message):
    if not holds:
        raise TemplateFault(message)


def keys(thing, required, optional=()):
    check(isinstance(thing, dict), f"{thing!r}: expected a mapping")
    check(set(required) <= set(thing), f"{thing}: lacks {set(required) - set(thing)}")
    unknown = set(thing) - set(required) - set(optional)
    check(not unknown, f"unknown keys {unknown}")


def is_text(value, most):
    return isinstance(value, str) and 1 <= len(value) <= most and not re.search(r"[\x00-\x1f\x7f]", value)


def numbers_of(expression):
    """Returns the integers of an <IntRangeExpr>, in increasing order."""
    numbers = []
    for element in expression.split(","):
        match = re.fullmatch(r"\s*(-?\d+)(?:\s*-\s*(-?\d+)(?::(-?[1-9]\d*))?)?\s*", element)
        check(match, f"range {expression!r}")
        first, last, step = match[1], match[2] or match[1], match[3] or "1"
        numbers += range(int(first), int(last) + (1 if int(step) > 0 else -1), int(step))
    check(len(set(numbers)) == len(numbers), f"range {expression!r}: ranges overlap")
    return sorted(numbers)


def check_action(action):
    keys(action, ["command"], ["args", "timeout", "cancelation"])
    texts = [action["command"], *action.get("args", [])]
    check(all(isinstance(text, str) and not re.search(r"[\x00-\x1f\x7f]", text) for text in texts), "args")
    cancelation = action.get("cancelation", {"mode": "TERMINATE"})
    keys(cancelation, ["mode"], ["notifyPeriodInSeconds"])
    check(cancelation["mode"] in ("TERMINATE", "NOTIFY_THEN_TERMINATE"), "cancelation")
    check(1 <= cancelation.get("notifyPeriodInSeconds", 120) <= MOST_NOTIFY_SECONDS, "notifyPeriodInSeconds")


def check_step(step, names):
    keys(step, ["name", "script"], ["description", "dependencies", "hostRequirements", "parameterSpace"])
    check(is_text(step["name"], 64) and step["name"] not in names, f"step {step['name']!r}")
    for dependency in step.get("dependencies", []):
        keys(dependency, ["dependsOn"])
        check(dependency["dependsOn"] in names, f"dependsOn {dependency['dependsOn']}")
    if "hostRequirements" in step:
        keys(step["hostRequirements"], [], ["amounts"])
        for amount in step["hostRequirements"]["amounts"]:
            keys(amount, ["name"], ["min", "max"])
            check(amount["name"] in ("amount.worker.vcpu", "amount.worker.memory"), amount["name"])
            check(amount["min"] > 0, "amount")
    if "parameterSpace" in step:
        keys(step["parameterSpace"], ["taskParameterDefinitions"])
        parameter, = step["parameterSpace"]["taskParameterDefinitions"]
        keys(parameter, ["name", "type", "range"])
        check(NAME.fullmatch(parameter["name"]) and parameter["type"] == "INT", f"{parameter}")
        numbers_of(parameter["range"])
    keys(step["script"], ["actions"], ["embeddedFiles"])
    keys(step["script"]["actions"], ["onRun"])
    check_action(step["script"]["actions"]["onRun"])
    for file in step["script"].get("embeddedFiles", []):
        keys(file, ["name", "type", "data"], ["filename", "runnable"])
        check(NAME.fullmatch(file["name"]) and file["type"] == "TEXT" and file["data"], f"{file}")


def read_template(path):
    """Returns a template. Raises TemplateFault."""
    template = yaml.safe_load(pathlib.Path(path).read_text())
    keys(template, ["specificationVersion", "name", "steps"], ["description", "parameterDefinitions"])
    check(template["specificationVersion"] == "jobtemplate-2023-09", "specificationVersion")
    check(is_text(template["name"], 128), "name")
    for parameter in template.get("parameterDefinitions", []):
        keys(parameter, ["name", "type"], ["description", "default", "objectType", "dataFlow"])
        check(NAME.fullmatch(parameter["name"]) and parameter["type"] == "PATH", f"{parameter}")
        check(parameter.get("objectType", "DIRECTORY") in ("FILE", "DIRECTORY"), "objectType")
        check(parameter.get("dataFlow", "NONE") in ("NONE", "IN", "OUT", "INOUT"), "dataFlow")
        check(len(parameter["default"]) <= 1024, "default")
    check(template["steps"], "no steps")
    names = []
    for step in template["steps"]:
        check_step(step, names)
        names.append(step["name"])
    return template


class Task:
    """A task of a step, with its values."""

    def __init__(self, step, values):
        self.step, self.values = step, values
        self.progress, self.statuses, self.failure = [], [], None
        self.process = self.session = None

    def resolved(self, text):
        return REFERENCE.sub(lambda match: self.values[match[1]], text)

    def start(self):
        self.session = tempfile.TemporaryDirectory()
        for file in self.step["script"].get("embeddedFiles", []):
            path = pathlib.Path(self.session.name, file["name"])
            path.write_text(self.resolved(file["data"]))
            path.chmod(stat.S_IRUSR | (stat.S_IXUSR if file.get("runnable") else 0))
            self.values[f"Task.File.{file['name']}"] = str(path)
        action = self.step["script"]["actions"]["onRun"]
        words = [self.resolved(text) for text in [action["command"], *action.get("args", [])]]
        self.process = subprocess.Popen(words, cwd=self.session.name, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True, start_new_session=True)

    def cancel(self):
        """Cancels the running action as its template asks for, but without a limit of time."""
        mode = self.step["script"]["actions"]["onRun"].get("cancelation", {}).get("mode")
        self.process.send_signal(signal.SIGTERM if mode == "NOTIFY_THEN_TERMINATE" else signal.SIGKILL)

    def end(self):
        """Waits for the action, reads its messages, and returns its exit code."""
        output = self.process.communicate()[0]
        for line in output.splitlines():
            if match := re.match(r"^openjd_(progress|status|fail): (.*)$", line):
                if match[1] == "progress":
                    self.progress.append(float(match[2]))
                    check(0 <= self.progress[-1] <= 100, line)
                elif match[1] == "status":
                    self.statuses.append(match[2])
                else:
                    self.failure = match[2]
        self.session.cleanup()
        return self.process.returncode


def tasks_of(template):
    """Returns the tasks of each step, in an order in which they may run."""
    values = {f"Param.{parameter['name']}": parameter["default"]
              for parameter in template.get("parameterDefinitions", [])}
    steps = []
    for step in template["steps"]:
        if "parameterSpace" not in step:
            steps.append([Task(step, dict(values))])
            continue
        parameter, = step["parameterSpace"]["taskParameterDefinitions"]
        steps.append([Task(step, {**values, f"Task.Param.{parameter['name']}": str(number)})
                      for number in numbers_of(parameter["range"])])
    return steps
