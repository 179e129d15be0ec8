#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks what a forge reads: workflows and templates are well formed, each step runs one job of .ci/job and nothing of
its own, every job is run by a workflow, and every script that is called exists and can be executed.

usage: workflows_test.py REPOSITORY
"""
import os
import pathlib
import re
import subprocess
import sys
import unittest

import yaml

REPOSITORY = pathlib.Path(sys.argv.pop()).resolve()
FORGE = REPOSITORY / ".github"
# The one command that cannot be a script of the project, because it precedes the checkout.
BEFORE_CHECKOUT = "apt-get -q update && apt-get -q -y install --no-install-recommends git ca-certificates"
CALL = re.compile(r"\.ci/job (?:(?P<job>[a-z0-9]+)|\$\{\{ matrix\.(?P<list>\w+) \}\})")
# A script of the project that a line of .ci/job calls: ./test, scripts/hunt.sh asan.
CALLED = re.compile(r"^\s*(?:[A-Z_]+=\w+ )*(\./\w+|scripts/[\w./]+)", re.M)


def listed_jobs():
    lines = subprocess.run([REPOSITORY / ".ci/job", "--list"], capture_output=True, text=True, check=True).stdout
    return [line.split()[0] for line in lines.splitlines()]


def workflows():
    return {path.name: yaml.safe_load(path.read_text()) for path in sorted(FORGE.glob("workflows/*.yml"))}


def jobs_of(step, job):
    """Returns the names that a step gives to .ci/job, for all values of the matrix of its job."""
    call = CALL.fullmatch(step["run"])
    if not call:
        return []
    return [call["job"]] if call["job"] else job["strategy"]["matrix"][call["list"]]


class Workflows(unittest.TestCase):
    def test_each_job_has_a_limit_and_a_container_of_debian_12(self):
        self.assertTrue(workflows())
        for name, workflow in workflows().items():
            # YAML 1.1 reads the key "on" as true.
            self.assertEqual(set(workflow) - {"concurrency"}, {"name", True, "permissions", "jobs"}, name)
            self.assertEqual(workflow["permissions"], {"contents": "read"}, name)
            for key, job in workflow["jobs"].items():
                with self.subTest(workflow=name, job=key):
                    self.assertLessEqual(set(job), {"strategy", "name", "if", "runs-on", "container", "timeout-minutes",
                                                    "steps"})
                    self.assertTrue(0 < job["timeout-minutes"] <= 360)
                    self.assertEqual(job["container"]["image"], "debian:12")

    def test_each_step_is_the_checkout_or_one_job(self):
        for name, workflow in workflows().items():
            for key, job in workflow["jobs"].items():
                with self.subTest(workflow=name, job=key):
                    before, checkout, call = job["steps"]
                    self.assertEqual(before, {"run": BEFORE_CHECKOUT})
                    self.assertRegex(checkout["uses"], r"^actions/checkout@v\d+$")
                    self.assertEqual(checkout["with"], {"fetch-depth": 0})  # house tests read the history
                    self.assertEqual(set(call), {"run"})
                    self.assertTrue(jobs_of(call, job), call)

    def test_the_jobs_that_are_run_are_those_that_are_listed(self):
        run = [name for workflow in workflows().values() for job in workflow["jobs"].values()
               for name in jobs_of(job["steps"][-1], job)]
        self.assertEqual(sorted(run), sorted(listed_jobs()))

    def test_scripts_that_jobs_call_exist_and_can_be_executed(self):
        called = CALLED.findall((REPOSITORY / ".ci/job").read_text())
        self.assertIn("./test", called)
        self.assertIn("scripts/hunt.sh", called)
        for name in called:
            self.assertTrue(os.access(REPOSITORY / name, os.X_OK), f"{name} is called by .ci/job")

    def test_an_unknown_job_is_an_error_that_names_the_jobs(self):
        for words in ([], ["gc"], ["gcc", "clang"], ["calm_addresses"]):
            done = subprocess.run([REPOSITORY / ".ci/job", *words], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout), (2, ""), words)
            self.assertIn(" ".join(listed_jobs()), done.stderr)


class Templates(unittest.TestCase):
    def test_templates_of_issues_have_a_name_and_say_what_they_are_for(self):
        templates = sorted(FORGE.glob("ISSUE_TEMPLATE/*.md"))
        self.assertTrue(templates)
        for path in templates:
            head = re.match(r"---\n(.*?)\n---\n\n\S", path.read_text(), re.S)
            self.assertTrue(head, f"{path.name} has no head between lines of ---")
            facts = yaml.safe_load(head[1])
            self.assertLessEqual({"name", "about"}, set(facts), path.name)
            self.assertTrue(all(isinstance(value, str) and value for value in facts.values()), path.name)

    def test_the_template_of_patches_names_files_that_exist(self):
        text = (FORGE / "pull_request_template.md").read_text()
        names = re.findall(r"[\w./]+/[\w./]+\.(?:md|sh)|[A-Z]+\.md", text)
        self.assertTrue(names)
        for name in names:
            self.assertTrue((REPOSITORY / name).is_file(), name)
        self.assertIn("- [ ] ", text)


if __name__ == "__main__":
    unittest.main()
