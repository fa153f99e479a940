namespace mercury {}
