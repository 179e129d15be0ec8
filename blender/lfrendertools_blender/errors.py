# SPDX-License-Identifier: Apache-2.0
"""The errors that a user can remedy. Each has the exit code that the programs of lfrendertools use for its kind."""


class Failure(Exception):
    """An error with a message that states what is wrong and what to do."""
    exit_code = 1


class UsageError(Failure):
    exit_code = 2


class InputError(Failure):
    exit_code = 3


class OutputError(Failure):
    exit_code = 4
