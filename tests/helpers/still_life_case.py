# SPDX-License-Identifier: Apache-2.0
"""A test case with a small light field of lfsynth's still life, which all tests of a class share."""
import os
import tempfile

from program_test_case import ProgramTestCase


class StillLifeCase(ProgramTestCase):
    SYNTH = None  # the program lfsynth

    @classmethod
    def setUpClass(cls):
        cls.captured = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.captured.cleanup)

    @property
    def field(self):
        """Returns the folder of 15 x 15 LF cameras, 3.2 mm apart, whose images have 320 x 212 pixels."""
        field = os.path.join(self.captured.name, "field")
        if not os.path.exists(field):
            self.succeeds(self.SYNTH, "still-life", "-o", field, "--count", 225, "--size", "320x212", "--spacing",
                          0.0032, "-q")
        return field
