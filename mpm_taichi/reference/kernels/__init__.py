"""The stages of a step, one file each.

`sort`, `rows` and `blocks` of the fast form are about memory and threads: they have no twin."""
