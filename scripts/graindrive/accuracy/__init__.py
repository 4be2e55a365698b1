"""What cheaper settings of a study change, measured and kept in books, and the choice that `accuracy=` makes by them."""
