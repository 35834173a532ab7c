"""The stages of a step, one file each: free of dimension, law, basis and transfer."""
