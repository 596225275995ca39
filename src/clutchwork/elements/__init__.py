"""Elements, one file each; every file in this folder is an element."""
