# SPDX-License-Identifier: Apache-2.0
"""A test case with a folder of its own, in which it calls programs."""
import pathlib
import subprocess
import tempfile
import time
import unittest


def wait_until(holds, process):
    """Waits until holds() returns true or the process has ended. No time limit but that of the whole test ends the
    wait, because a machine may be slow."""
    while not holds() and process.poll() is None:
        time.sleep(0.002)


class ProgramTestCase(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)

    def call(self, program, *arguments):
        return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True,
                              timeout=400)

    def succeeds(self, program, *arguments, code=0):
        result = self.call(program, *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stdout

    def fails(self, code, words, program, *arguments):
        """Calls a program that must end with this exit status and these words on the last line."""
        result = self.call(program, *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        last = result.stderr.strip().splitlines()[-1]
        self.assertTrue(last.startswith("error: "), last)
        for word in words:
            self.assertIn(word, last)
